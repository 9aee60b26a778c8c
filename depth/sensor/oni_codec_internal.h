#pragma once
#include <cstdint>
#include <span>
#include <vector>

namespace ossa::depth {

/// OpenNI2's depth codec "16zT": the values that occur, in a table, then the pixels as differences
/// of table positions in half bytes. Appends to `out`. Empty frames and frames with more than
/// kLargestOniTable different values cannot be written: returns false.
inline constexpr int kLargestOniTable = 32767;
bool EncodeOniDepth(std::span<const uint16_t> depth_mm, std::vector<uint8_t>* out);

}  // namespace ossa::depth
