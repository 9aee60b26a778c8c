#pragma once
#include <filesystem>
#include <vector>

#include "forest/forest.h"

namespace ossa::forest {

/// Imports the people trees published with the Point Cloud Library as a forest of 25 classes (text:
/// depth, then "du1 dv1 du2 dv2 threshold" per node in heap order, then one label per leaf). Throws
/// InputError that names file and line.
ForestModel ImportPclTrees(const std::vector<std::filesystem::path>& paths);

}  // namespace ossa::forest
