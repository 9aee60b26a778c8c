#pragma once
#include <cstdint>
#include <filesystem>
#include <string>

#include "depth/image/depth_frame.h"
#include "depth/image/image.h"

namespace ossa::depth {

/// Size of an image in pixels.
struct ImageSize {
  int width = 0;
  int height = 0;
  bool operator==(const ImageSize&) const = default;
};

/// "640x480".
std::string SizeText(ImageSize size);

/// A depth image file: PNG, one 16-bit grey channel, millimetres, 0 = no reading.
/// Throws InputError naming the file, the place and what was expected: not a PNG, another channel
/// layout or bit depth, absurd size, damaged or cut short.
Image<uint16_t> ReadDepthPng(const std::filesystem::path& path);

/// Only the size of a depth image: reads and checks the header, not the pixels.
ImageSize ReadDepthPngSize(const std::filesystem::path& path);

/// True for a PNG with a valid header that is not a depth image: colour, or 8 bits.
bool IsOtherPng(const std::filesystem::path& path);

/// Writes atomically, one of many (AtomicFile::CommitOneOfMany); the same image gives the same
/// bytes.
void WriteDepthPng(const std::filesystem::path& path, const DepthView& depth);

/// A label image file (part or user per pixel): PNG, one 8-bit grey channel. Throws as above.
Image<uint8_t> ReadLabelPng(const std::filesystem::path& path);
void WriteLabelPng(const std::filesystem::path& path, const Image<uint8_t>& labels);

}  // namespace ossa::depth
