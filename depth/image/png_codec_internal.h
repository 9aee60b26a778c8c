#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "depth/image/depth_png.h"

namespace ossa::depth {

/// Grey PNGs in memory; `name` stands for the file in messages. Samples are in native byte order.
/// This reads the size of a one-channel PNG of `bit_depth` bits; throws InputError for anything
/// else.

/// Size of a one-channel PNG of `bit_depth` bits; throws InputError for anything else.
ImageSize DecodeGreyPngHeader(std::span<const uint8_t> bytes, int bit_depth,
                              const std::string& name);

/// Whether this is a PNG in colour or of another bit depth.
bool IsPngOfOtherKind(std::span<const uint8_t> bytes, int bit_depth);

/// As above, and decodes the pixels: row-major, height × width samples of bit_depth / 8 bytes.
ImageSize DecodeGreyPng(std::span<const uint8_t> bytes, int bit_depth, const std::string& name,
                        std::vector<uint8_t>* samples);

/// `stride` in bytes from one row to the next.
std::vector<uint8_t> EncodeGreyPng(const uint8_t* samples, ImageSize size, size_t stride,
                                   int bit_depth);

}  // namespace ossa::depth
