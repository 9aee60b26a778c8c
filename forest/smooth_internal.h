#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "forest/feature_internal.h"
#include "forest/sparse_internal.h"

namespace ossa::forest {

inline constexpr int kMaxSmoothRadius_px = 31;  // windows of 63: their sums fit 16 bits

/// Class masses of one object's pixels, as its samples (the pixels that walked) gave them.
struct MassImage {
  const ObjectImage* image = nullptr;
  std::span<const int32_t> position;     // y << 16 | x, box coordinates, ascending
  const SparsePixels* sparse = nullptr;  // which sample speaks for each pixel
  const uint8_t* mass = nullptr;         // sample × stride, each at most 255
  size_t stride = 0;                     // a multiple of 16
};

struct SmoothMasses {
  std::vector<uint16_t> mass;  // sample × stride: masses around the sample itself, × 4
  std::vector<uint8_t> label;  // of each pixel: its largest column + 1; 0: there is no mass
};

/// Every pixel's masses averaged over the rows of a square window around it, rows added up (× 4).
/// A window ends where the object does and where the depth jumps. Integers: the same bits on every
/// machine.
SmoothMasses Smooth(const MassImage& masses, int radius_px);

}  // namespace ossa::forest
