#pragma once
#include <Eigen/Core>
#include <Eigen/Geometry>

namespace ossa::recon {

/// The smallest rotation from the direction of `from` to that of `to`, of any non-zero lengths; for
/// opposite directions one of the half turns. Compiled once: Eigen's implementation contains a
/// singular value decomposition that costs every including source seconds.
Eigen::Quaterniond SmallestTurn(const Eigen::Vector3d& from, const Eigen::Vector3d& to);
Eigen::Quaternionf SmallestTurn(const Eigen::Vector3f& from, const Eigen::Vector3f& to);

/// Angle between two directions of any length, radians, [0, pi].
double AngleBetween_rad(const Eigen::Vector3d& a, const Eigen::Vector3d& b);

/// Rotation vector of a unit quaternion of either sign: axis times angle in radians, [0, pi].
Eigen::Vector3d ToRotationVector(Eigen::Quaterniond rotation);

}  // namespace ossa::recon
