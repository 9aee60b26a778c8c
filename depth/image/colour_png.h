#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "depth/image/depth_png.h"

namespace ossa::depth {

/// Encodes a picture as PNG. `samples`: 8 bits each, height × width × channels, row-major; three
/// channels are red, green and blue, a fourth is alpha. Optimised for size. Throws
/// std::invalid_argument if size, channels and samples do not match.
std::vector<uint8_t> EncodeColourPng(std::span<const uint8_t> samples, ImageSize size,
                                     int channels);

}  // namespace ossa::depth
