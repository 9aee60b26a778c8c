#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "depth/image/camera.h"

namespace ossa::depth {

/// A borrowed depth image: row-major height × width, millimetres, 0 = no reading.
struct DepthView {
  const uint16_t* data_mm = nullptr;
  int width = 0;
  int height = 0;
  int stride = 0;  // elements from one row to the next

  uint16_t at(int u, int v) const { return data_mm[static_cast<ptrdiff_t>(v) * stride + u]; }
  /// By row-major index, v width + u.
  uint16_t at(int32_t pixel) const {
    return stride == width ? data_mm[pixel] : at(pixel % width, pixel / width);
  }
  bool Contains(int u, int v) const { return u >= 0 && v >= 0 && u < width && v < height; }
};

/// One depth image of a sensor. The image has camera.width × camera.height pixels.
struct DepthFrame {
  std::vector<uint16_t> depth_mm;  // row-major, height × width; 0 = no reading
  Camera camera;
  double time_s = 0.0;  // sensor clock, seconds
  int64_t index = 0;    // frame number of the source, from 0
  // An image in memory that outlives this frame and its copies, such as a driver's buffer, used
  // instead of depth_mm; ignored without data.
  DepthView borrowed = {};

  DepthView view() const {
    if (borrowed.data_mm != nullptr) return borrowed;
    return {depth_mm.data(), camera.width, camera.height, camera.width};
  }
  /// Number of pixels of the image itself; the camera may state another size.
  size_t pixel_count() const {
    if (borrowed.data_mm == nullptr) return depth_mm.size();
    return static_cast<size_t>(borrowed.width) * static_cast<size_t>(borrowed.height);
  }
};

}  // namespace ossa::depth
