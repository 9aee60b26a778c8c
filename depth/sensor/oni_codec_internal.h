#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace ossa::depth {

/// OpenNI2's depth codec "16zT": the values that occur, in a table, then the pixels as differences
/// of table positions in half bytes. Appends to `out`. Empty frames and frames with more than
/// kLargestOniTable different values cannot be written: returns false.
inline constexpr int kLargestOniTable = 32767;
bool EncodeOniDepth(std::span<const uint16_t> depth_mm, std::vector<uint8_t>* out);

/// What EncodeOniDepth wrote of an image of so many pixels; false for bytes that it never writes.
bool DecodeOniDepth(std::span<const uint8_t> data, size_t pixels, std::vector<uint16_t>* depth_mm);

}  // namespace ossa::depth
