#pragma once
#include <cstdint>
#include <memory>
#include <span>

#include "forest/feature_internal.h"

namespace ossa::forest {

inline constexpr int kMaxSmoothRadius_px = 31;  // windows of 63: their sums fit 16 bits

/// Class masses of one object's pixels: pixel × stride, stride a multiple of 16, each at most 255.
struct MassImage {
  const ObjectImage* image = nullptr;
  std::span<const int32_t> position;  // y << 16 | x, box coordinates, ascending
  const uint8_t* mass = nullptr;
  size_t stride = 0;
};

/// Every pixel's masses averaged over the rows of a square window around it, rows added up (× 4).
/// A window ends where the object does and where the depth jumps. Integers: the same bits on every
/// machine. Pixel × stride.
std::unique_ptr<uint16_t[]> SmoothMasses(const MassImage& masses, int radius_px);

}  // namespace ossa::forest
