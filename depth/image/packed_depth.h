#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "depth/image/depth_frame.h"

namespace ossa::depth {

/// The image, row-major height × width without gaps between rows: the image itself, or a copy in
/// `scratch` if its rows have gaps. Valid as long as both.
inline std::span<const uint16_t> PackedDepth(const DepthView& image,
                                             std::vector<uint16_t>& scratch) {
  if (image.stride == image.width) {
    return {image.data_mm, static_cast<size_t>(image.width) * static_cast<size_t>(image.height)};
  }
  scratch.clear();
  for (int v = 0; v < image.height; ++v) {
    const uint16_t* row = image.data_mm + static_cast<ptrdiff_t>(v) * image.stride;
    scratch.insert(scratch.end(), row, row + image.width);
  }
  return scratch;
}

/// Whether the image itself, not only its camera, has this size, pixels.
inline bool HasSize(const DepthFrame& frame, int width, int height) {
  const bool pixels_are_there = frame.pixel_count() == static_cast<size_t>(frame.camera.width) *
                                                           static_cast<size_t>(frame.camera.height);
  const DepthView view = frame.view();
  return pixels_are_there && frame.camera.width == width && frame.camera.height == height &&
         view.width == width && view.height == height;
}

}  // namespace ossa::depth
