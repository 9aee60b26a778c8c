#include "depth/sensor/openni2/delivered_depth.h"

#include <algorithm>
#include <cstring>
#include <string>

#include "depth/base/error.h"

namespace ossa::depth {

std::vector<uint16_t> MillimetresOf(const DeliveredDepth& frame) {
  const int width = frame.width, height = frame.height;
  if (width <= 0 || height <= 0 || frame.stride < 2 * width ||
      int64_t{frame.stride} * (height - 1) + 2 * width > frame.size) {
    throw InputError("expected " + std::to_string(width) + "x" + std::to_string(height) +
                     " depths, found a frame of " + std::to_string(frame.size) + " bytes");
  }
  std::vector<uint16_t> depth_mm(static_cast<size_t>(width) * static_cast<size_t>(height));
  for (int v = 0; v < height; ++v) {
    uint16_t* row = depth_mm.data() + static_cast<ptrdiff_t>(v) * width;
    std::memcpy(row, static_cast<const char*>(frame.data) + ptrdiff_t{frame.stride} * v,
                2 * static_cast<size_t>(width));
    if (frame.tenths) {
      std::transform(row, row + width, row,
                     [](uint16_t d) { return static_cast<uint16_t>((d + 5) / 10); });
    }
    if (frame.mirrored) std::reverse(row, row + width);
  }
  return depth_mm;
}

}  // namespace ossa::depth
