#pragma once
#include <filesystem>
#include <vector>

#include "forest/forest.h"

namespace ossa::forest {

/// A forest of 25 classes out of the people trees published with the Point Cloud Library (text:
/// depth, then "du1 dv1 du2 dv2 threshold" a node in heap order, then a label a leaf). Throws
/// InputError that names the file and line.
ForestModel ImportPclTrees(const std::vector<std::filesystem::path>& paths);

}  // namespace ossa::forest
