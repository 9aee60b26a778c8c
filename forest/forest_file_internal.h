#pragma once
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "forest/forest.h"

namespace ossa::forest {

/// The uncompressed payload of a current file, for a model with these trees, which need not be the
/// data's.
std::vector<std::byte> PackForest(const ForestData& data, std::span<const Tree> trees);
/// Throws InputError that names `name` and the field.
ForestData ParseForest(std::span<const std::byte> payload, const std::string& name);

}  // namespace ossa::forest
