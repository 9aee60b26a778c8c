#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "depth/image/camera.h"

namespace ossa::depth {

/// A depth camera with distortion: a pinhole, then the rational Brown-Conrady model of OpenCV and
/// of the Azure Kinect SDK (k4a_calibration_intrinsic_parameters_t). Pixel conventions as in
/// Camera.
struct LensCamera {
  Camera pinhole;
  double k1 = 0, k2 = 0, k3 = 0, k4 = 0, k5 = 0, k6 = 0;  // radial
  double p1 = 0, p2 = 0;                                  // tangential
  double largest_radius = 0;                              // largest calibrated x/z and y/z of a ray
};

/// The radius up to which the distortion is monotone: beyond, a model that was calibrated only for
/// the centre folds back.
double ComputeFoldingRadius(const LensCamera& lens);

/// For each pixel of the pinhole image the pixel of the distorted image to copy, or -1 if there is
/// none. Depth along the axis is the same in both.
std::vector<int32_t> UndistortionMap(const LensCamera& lens);

std::vector<uint16_t> Undistorted(std::span<const uint16_t> depth, const std::vector<int32_t>& map);

}  // namespace ossa::depth
