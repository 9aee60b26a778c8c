#include "recon/smallest_turn.h"

#include <cmath>

namespace ossa::recon {

Eigen::Quaterniond SmallestTurn(const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  return Eigen::Quaterniond::FromTwoVectors(from, to);
}

Eigen::Quaternionf SmallestTurn(const Eigen::Vector3f& from, const Eigen::Vector3f& to) {
  return Eigen::Quaternionf::FromTwoVectors(from, to);
}

double AngleBetween_rad(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

Eigen::Vector3d ToRotationVector(Eigen::Quaterniond rotation) {
  if (rotation.w() < 0.0) rotation.coeffs() = -rotation.coeffs();
  const double sine = rotation.vec().norm();
  if (sine < 1e-12) return 2.0 * rotation.vec();
  return rotation.vec() * (2.0 * std::atan2(sine, rotation.w()) / sine);
}

}  // namespace ossa::recon
