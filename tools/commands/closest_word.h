#pragma once
#include <span>
#include <string>
#include <string_view>

namespace ossa::commands {

/// The word closest to `typed` by insertions, deletions, changes and swaps of neighbours (optimal
/// string alignment), or the only one that it is a prefix of; "" if none is close. Ties go to the
/// first.
std::string ClosestWord(std::string_view typed, std::span<const std::string> words);

}  // namespace ossa::commands
