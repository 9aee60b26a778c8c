#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "forest/classification/sample_grid_internal.h"
#include "forest/trees/depth_feature_internal.h"

namespace ossa::forest {

inline constexpr int kMaxSmoothRadius = 31;  // windows of 63: their sums fit 16 bits; derived

/// Class masses of an object's samples, as classified by the trees.
struct MassImage {
  const SparsePixels* sparse = nullptr;  // the grid of the samples
  const uint8_t* mass = nullptr;         // sample × stride, each at most 255
  size_t stride = 0;                     // a multiple of 16
};

struct SmoothMasses {
  size_t stride = 0;
  std::vector<uint16_t> mass;  // sample × stride: smoothed masses, × 4
  std::vector<uint8_t> label;  // per sample: its largest column + 1; 0: no mass
};

/// Averages masses along the rows of a square window of the grid and sums over its rows (× 4).
/// Windows end at the object's border and at depth discontinuities; off-grid samples are not
/// smoothed. Integers: the same bits on every machine.
SmoothMasses Smooth(const MassImage& masses, int radius);

/// The label of each pixel, from the smoothed masses of the four surrounding samples on its
/// surface, interpolated bilinearly.
std::vector<uint8_t> LabelPixels(const ObjectImage& image, std::span<const int32_t> position,
                                 const SparsePixels& sparse, const SmoothMasses& smooth);

}  // namespace ossa::forest
