#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "depth/image/camera.h"

namespace ossa::depth {

/// A depth camera with a lens: pinhole, then the rational Brown-Conrady distortion of OpenCV and of
/// the Azure Kinect SDK (k4a_calibration_intrinsic_parameters_t). Pixels and centres as Camera has
/// them.
struct LensCamera {
  Camera pinhole;
  double k1 = 0, k2 = 0, k3 = 0, k4 = 0, k5 = 0, k6 = 0;  // radial
  double p1 = 0, p2 = 0;                                  // tangential
  double largest_radius = 0;  // of a ray, x/z and y/z, that the lens is calibrated for
};

/// Up to which radius things that lie farther out are seen farther out: beyond, a lens that is
/// stated for the middle alone folds back, and shows nothing.
double ComputeFoldingRadius(const LensCamera& lens);

/// For each pixel of the pinhole image the pixel of the lens's image to copy, or -1 where it shows
/// nothing of it. Depth along the axis is the same in both.
std::vector<int32_t> UndistortionMap(const LensCamera& lens);

std::vector<uint16_t> Undistorted(std::span<const uint16_t> depth, const std::vector<int32_t>& map);

}  // namespace ossa::depth
