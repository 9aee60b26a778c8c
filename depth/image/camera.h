#pragma once
#include <Eigen/Core>
#include <cmath>
#include <string>

namespace ossa::depth {

/// Images larger than this in either direction are refused before anything is allocated: no depth
/// camera comes near it, and a hostile header could ask for 16 GB.
inline constexpr int kLargestImageSide = 8192;  // pixels; chosen by hand

/// A pinhole depth camera without distortion. Pixel centres lie at integer (u, v); u grows to the
/// image right, v down. Camera space: metres, right-handed, x to the sensor's left, y up, z
/// forward.
struct Camera {
  int width = 640;    // pixels
  int height = 480;   // pixels
  double fx = 575.0;  // focal lengths, pixels
  double fy = 575.0;
  double cx = 320.0;  // principal point, pixels
  double cy = 240.0;

  bool operator==(const Camera&) const = default;
};

/// Whether the parameters are possible: sides of 1 to kLargestImageSide pixels, focal lengths of
/// 0.1 to 1e6, a principal point within 1e6 pixels of the image's corner. Very short focal lengths
/// and principal points far outside the image are allowed; 0, NaN and the like are not.
bool IsSane(const Camera& camera);
/// Throws InputError naming the first field that is not. `name` stands for its origin in the
/// message, e.g. "FILE: camera".
void CheckCamera(const Camera& camera, const std::string& name);

/// The Kinect v1 depth camera: f = 575 px at 640 pixels width, principal point at the image centre.
Camera KinectV1Camera(int width, int height);

/// The same view sampled at another width and height.
Camera Resized(const Camera& camera, int width, int height);

/// The camera of a crop: width × height pixels whose upper left one is (left, top).
Camera Cropped(const Camera& camera, int left, int top, int width, int height);

/// The one conversion from sensor units to metres.
inline double MetresFromMillimetres(double depth_mm) { return depth_mm * 1e-3; }

/// Camera-space point, metres, of pixel (u, v) at depth_mm > 0 along the optical axis.
inline Eigen::Vector3d BackProject(const Camera& camera, double u, double v, double depth_mm) {
  const double z = MetresFromMillimetres(depth_mm);
  return {(camera.cx - u) * z / camera.fx, (camera.cy - v) * z / camera.fy, z};
}

/// Pixel (u, v) of a camera-space point, metres; the exact inverse of BackProject. Precondition: z
/// > 0.
inline Eigen::Vector2d Project(const Camera& camera, const Eigen::Vector3d& position_m) {
  return {camera.cx - camera.fx * position_m.x() / position_m.z(),
          camera.cy - camera.fy * position_m.y() / position_m.z()};
}

}  // namespace ossa::depth
