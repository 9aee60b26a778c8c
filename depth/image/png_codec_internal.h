#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "depth/image/depth_png.h"

namespace ossa::depth {

/// Grey PNGs in memory; `name` stands for the file in messages. Samples are in machine order.

/// Size of a one-channel PNG of `bit_depth` bits; throws InputError for anything else.
ImageSize DecodeGreyPngHeader(std::span<const uint8_t> bytes, int bit_depth,
                              const std::string& name);

/// Whether this begins as a PNG does, but of colours or of another bit depth.
bool IsPngOfOtherKind(std::span<const uint8_t> bytes, int bit_depth);

/// As above, with the pixels: row-major, height × width samples of bit_depth / 8 bytes.
ImageSize DecodeGreyPng(std::span<const uint8_t> bytes, int bit_depth, const std::string& name,
                        std::vector<uint8_t>* samples);

/// `stride` in bytes from one row to the next.
std::vector<uint8_t> EncodeGreyPng(const uint8_t* samples, ImageSize size, size_t stride,
                                   int bit_depth);

}  // namespace ossa::depth
