#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "forest/classification/sample_grid_internal.h"
#include "forest/trees/depth_feature_internal.h"

namespace ossa::forest {

inline constexpr int kMaxSmoothRadius = 31;  // windows of 63: their sums fit 16 bits; derived

/// Class masses of one object's samples, as the trees gave them.
struct MassImage {
  const SparsePixels* sparse = nullptr;  // the grid they stand on
  const uint8_t* mass = nullptr;         // sample × stride, each at most 255
  size_t stride = 0;                     // a multiple of 16
};

struct SmoothMasses {
  size_t stride = 0;
  std::vector<uint16_t> mass;  // sample × stride: masses around it, × 4
  std::vector<uint8_t> label;  // of each sample: its largest column + 1; 0: there is no mass
};

/// Every sample's masses averaged over the rows of a square window of the grid around it, rows
/// added up (× 4). A window ends where the object does and where the depth jumps; samples off the
/// grid stand alone. Integers: the same bits on every machine.
SmoothMasses Smooth(const MassImage& masses, int radius);

/// The label of each pixel, from the smooth masses of the four samples around it that lie on its
/// surface, weighted bilinearly.
std::vector<uint8_t> LabelPixels(const ObjectImage& image, std::span<const int32_t> position,
                                 const SparsePixels& sparse, const SmoothMasses& smooth);

}  // namespace ossa::forest
