#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "depth/image/camera.h"

namespace ossa::depth {

/// A depth camera with a lens: pinhole, then the rational Brown-Conrady distortion of the Azure
/// Kinect SDK (k4a_calibration_intrinsic_parameters_t). Pixels and centres as Camera has them.
struct LensCamera {
  Camera pinhole;
  double k1 = 0, k2 = 0, k3 = 0, k4 = 0, k5 = 0, k6 = 0;  // radial
  double p1 = 0, p2 = 0;                                  // tangential
  double largest_radius = 0;  // of a ray, x/z and y/z, that the lens is calibrated for
};

/// The depth camera of a calibration that k4arecorder attached to a recording, for images of this
/// size: which mode of the sensor of 1024 × 1024 pixels they are of. Throws InputError naming what
/// was expected.
LensCamera ReadK4aCalibration(const std::string& json, int width, int height);

/// For each pixel of the pinhole image the pixel of the lens's image to copy, or -1 where it shows
/// nothing of it. Depth along the axis is the same in both.
std::vector<int32_t> UndistortionMap(const LensCamera& lens);

std::vector<uint16_t> Undistorted(std::span<const uint16_t> depth, const std::vector<int32_t>& map);

}  // namespace ossa::depth
