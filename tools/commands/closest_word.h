#pragma once
#include <span>
#include <string>
#include <string_view>

namespace ossa::commands {

/// The word that was most likely meant by `typed`: of fewest insertions, deletions, changes and
/// swaps of neighbours (optimal string alignment), or the only one that it begins; "" where none is
/// near. Of equals the first.
std::string ClosestWord(std::string_view typed, std::span<const std::string> words);

}  // namespace ossa::commands
