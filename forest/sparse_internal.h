#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "forest/feature_internal.h"

namespace ossa::forest {

/// Which pixels of an object walk the trees, and whose leaves each pixel takes.
struct SparsePixels {
  std::vector<int32_t> position;  // of those that walk: y << 16 | x, box coordinates
  std::vector<int32_t> from;      // a pixel: index into `position`
};

inline constexpr int kMostSparse = 4;

/// The first of every step × step pixels walks for the others on the same surface. Those that walk
/// stand tile by tile: neighbours meet the same nodes, and go together.
SparsePixels ChooseSparse(const ObjectImage& image, std::span<const int32_t> position, int step);

}  // namespace ossa::forest
