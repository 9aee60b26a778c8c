#pragma once
#include <cstdint>
#include <filesystem>

#include "depth/image/depth_png.h"
#include "depth/image/image.h"

namespace ossa::depth {

/// Depth image files by their extension, in any case: PNG, PGM and TIFF of 16 bits, TIFF of floats,
/// and NumPy's .npy of one image. Not those that macOS hides beside them (._NAME).
bool IsDepthFileName(const std::filesystem::path& path);

/// A depth image, 0 = no reading. Integers as they are, millimetres unless the user knows better;
/// floats are metres or millimetres, by their range (GuessUnit_mm). Throws InputError naming the
/// file and what was expected: another format, bit depth or number of channels, damaged, cut short.
Image<uint16_t> ReadDepthFile(const std::filesystem::path& path);

/// Only the size of a depth image: reads and checks the header, not the pixels.
ImageSize ReadDepthFileSize(const std::filesystem::path& path);

/// True for an image with a valid header that is not a depth image: colour, or 8 bits.
bool IsOtherImage(const std::filesystem::path& path);

}  // namespace ossa::depth
