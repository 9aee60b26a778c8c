#include "depth/image/camera.h"

namespace ossa::depth {

Camera KinectV1Camera(int width, int height) {
  const double f = 575.0 * width / 640.0;
  return {width, height, f, f, width / 2.0, height / 2.0};
}

Camera Resized(const Camera& camera, int width, int height) {
  const double sx = static_cast<double>(width) / camera.width;
  const double sy = static_cast<double>(height) / camera.height;
  return {width, height, camera.fx * sx, camera.fy * sy, camera.cx * sx, camera.cy * sy};
}

}  // namespace ossa::depth
