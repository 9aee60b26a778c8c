#pragma once
#include <Eigen/Core>

#include "depth/image/depth_frame.h"
#include "depth/image/image.h"

namespace ossa::depth {

/// Rotates an image clockwise by `quarters` quarter turns, 0 to 3; 4 - quarters rotate it back.

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

/// The camera of the rotated image; it is rotated about its optical axis in the opposite direction.
Camera Turned(const Camera& camera, int quarters);

DepthFrame Turned(const DepthFrame& frame, int quarters);

/// The camera of the image whose rows are reversed.
Camera Unmirrored(const Camera& camera);

/// Mirrors an image and its camera: converts the mirrored images (u = cx + fx x/z) that Kinect
/// SDKs, OpenNI2 and libfreenect2 deliver by default to the sensor's own view, and back.
DepthFrame Unmirrored(const DepthFrame& frame);

/// Rotation from the rotated camera's space to the camera's.
Eigen::Matrix3d CameraFromTurned(int quarters);

}  // namespace ossa::depth
