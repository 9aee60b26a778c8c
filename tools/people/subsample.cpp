#include "tools/people/subsample.h"

namespace ossa::people {

Subsampled Subsample(const depth::DepthFrame& frame, std::span<const int32_t> pixels, int scale) {
  const depth::Camera& full = frame.camera;
  Subsampled result;
  depth::Camera& camera = result.frame.camera;
  camera.width = (full.width + scale - 1) / scale;
  camera.height = (full.height + scale - 1) / scale;
  camera.fx = full.fx / scale;
  camera.fy = full.fy / scale;
  camera.cx = full.cx / scale;
  camera.cy = full.cy / scale;
  result.frame.depth_mm.assign(
      static_cast<size_t>(camera.width) * static_cast<size_t>(camera.height), 0);
  result.pixels.reserve(pixels.size() / static_cast<size_t>(scale * scale) + 64);
  const depth::DepthView view = frame.view();
  int32_t row_begin = 0, v = -1;
  for (const int32_t pixel : pixels) {
    if (pixel - row_begin >= full.width || v < 0) {
      v = pixel / full.width;
      row_begin = v * full.width;
    }
    const int32_t u = pixel - row_begin;
    if (v % scale != 0 || u % scale != 0) continue;
    const int32_t small = v / scale * camera.width + u / scale;
    result.frame.depth_mm[static_cast<size_t>(small)] = view.at(u, v);
    result.pixels.push_back(small);
  }
  return result;
}

}  // namespace ossa::people
