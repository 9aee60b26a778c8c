#pragma once
#include <cstdint>

#include "depth/image/camera.h"

namespace ossa::depth {

/// The part of the sensor's image that a frame shows: all of it, unless its stream is cropped.
struct ImageWindow {
  int32_t whole_width = 0, whole_height = 0;  // pixels, as everything here
  int32_t left = 0, top = 0;
  int32_t width = 0, height = 0;  // size of the frame

  /// Whether the window is inside the image.
  bool IsSane() const {
    return whole_width >= 1 && whole_width <= kLargestImageSide && whole_height >= 1 &&
           whole_height <= kLargestImageSide && left >= 0 && left < whole_width && top >= 0 &&
           top < whole_height && width >= 1 && width <= whole_width - left && height >= 1 &&
           height <= whole_height - top;
  }
};

/// The camera of the cropped image: `whole`, scaled if the image has another size (see
/// CameraForSize), with a shifted principal point.
Camera CropToWindow(const Camera& whole, const ImageWindow& window);

}  // namespace ossa::depth
