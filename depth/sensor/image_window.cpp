#include "depth/image/camera_io.h"
#include "depth/sensor/image_window_internal.h"

namespace ossa::depth {

Camera CropToWindow(const Camera& whole, const ImageWindow& window) {
  return Cropped(CameraForSize(whole, window.whole_width, window.whole_height), window.left,
                 window.top, window.width, window.height);
}

}  // namespace ossa::depth
