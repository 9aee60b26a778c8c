#pragma once
#include <Eigen/Core>

#include "depth/image/depth_frame.h"
#include "depth/image/image.h"

namespace ossa::depth {

/// Quarter turns of an image, clockwise as it is looked at, 0 to 3. Three more turn it back.

/// Pixel (u, v) of an image that is `height` pixels high lies at (height - 1 - v, u) after one
/// turn.
template <typename T>
Image<T> Turned(const Image<T>& image, int quarters) {
  if (quarters == 0) return image;
  const bool on_side = quarters % 2 == 1;
  Image<T> turned(on_side ? image.height : image.width, on_side ? image.width : image.height);
  const int w = image.width, h = image.height;
  for (int v = 0; v < h; ++v) {
    for (int u = 0; u < w; ++u) {
      const int to_u = quarters == 1 ? h - 1 - v : quarters == 2 ? w - 1 - u : v;
      const int to_v = quarters == 1 ? u : quarters == 2 ? h - 1 - v : w - 1 - u;
      turned.at(to_u, to_v) = image.at(u, v);
    }
  }
  return turned;
}

/// The camera that sees the turned image: it was turned the other way about its optical axis.
Camera Turned(const Camera& camera, int quarters);

DepthFrame Turned(const DepthFrame& frame, int quarters);

/// The camera of the image whose rows are reversed.
Camera Unmirrored(const Camera& camera);

/// As the sensor looks, of an image as a mirror shows it (u = cx + fx x/z, which Kinect SDKs,
/// OpenNI2 and libfreenect2 deliver by default) with the camera of that image. The same the other
/// way round.
DepthFrame Unmirrored(const DepthFrame& frame);

/// Takes points and directions of the turned camera's space to the camera's.
Eigen::Matrix3d CameraFromTurned(int quarters);

}  // namespace ossa::depth
