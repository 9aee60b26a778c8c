#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace ossa::depth {

/// OpenNI2's depth codec "16zT": a table of the occurring values, then the pixels as differences of
/// table indices in nibbles. Appends to `out`. Returns false for frames that cannot be encoded:
/// empty ones, and ones with more than kLargestOniTable different values.
inline constexpr int kLargestOniTable = 32767;
bool EncodeOniDepth(std::span<const uint16_t> depth_mm, std::vector<uint8_t>* out);

/// Decodes the output of EncodeOniDepth for `pixels` pixels; false for bytes that it never writes.
bool DecodeOniDepth(std::span<const uint8_t> data, size_t pixels, std::vector<uint16_t>* depth_mm);

}  // namespace ossa::depth
