#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "depth/image/depth_frame.h"

namespace ossa::depth {

/// The image row-major, height × width, without gaps: where it lies, or, where its rows have gaps,
/// copied to `room`.
inline std::span<const uint16_t> PackedDepth(const DepthView& image, std::vector<uint16_t>& room) {
  if (image.stride == image.width) {
    return {image.data_mm, static_cast<size_t>(image.width) * static_cast<size_t>(image.height)};
  }
  room.clear();
  for (int v = 0; v < image.height; ++v) {
    const uint16_t* row = image.data_mm + static_cast<ptrdiff_t>(v) * image.stride;
    room.insert(room.end(), row, row + image.width);
  }
  return room;
}

/// Whether the image itself, not only its camera, has so many pixels across and down.
inline bool HasSize(const DepthFrame& frame, int width, int height) {
  const bool pixels_are_there = frame.pixel_count() == static_cast<size_t>(frame.camera.width) *
                                                           static_cast<size_t>(frame.camera.height);
  const DepthView view = frame.view();
  return pixels_are_there && frame.camera.width == width && frame.camera.height == height &&
         view.width == width && view.height == height;
}

}  // namespace ossa::depth
