#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

namespace ossa::depth {

/// A depth frame as delivered by either of OpenNI2's interfaces.
struct DeliveredDepth {
  const void* data = nullptr;  // uint16, row by row
  int width = 0, height = 0;   // pixels
  int stride = 0;              // bytes from one row to the next
  int size = 0;                // bytes
  bool tenths = false;         // unit: tenths of a millimetre
  bool mirrored = false;
};

/// Millimetres, row-major height × width: tenths are rounded, mirrored rows reversed. Throws
/// InputError if there are fewer bytes than pixels.
std::vector<uint16_t> MillimetresOf(const DeliveredDepth& frame);

}  // namespace ossa::depth
