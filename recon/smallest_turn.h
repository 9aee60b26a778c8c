#pragma once
#include <Eigen/Core>
#include <Eigen/Geometry>

namespace ossa::recon {

/// The smallest rotation that takes the direction of `from` to that of `to`, of any lengths but 0;
/// for opposite directions one of the half turns. Eigen's own, compiled once: it holds a singular
/// value decomposition that costs each source that calls it seconds.
Eigen::Quaterniond SmallestTurn(const Eigen::Vector3d& from, const Eigen::Vector3d& to);
Eigen::Quaternionf SmallestTurn(const Eigen::Vector3f& from, const Eigen::Vector3f& to);

/// Between two directions of any length, radians, [0, pi].
double AngleBetween_rad(const Eigen::Vector3d& a, const Eigen::Vector3d& b);

/// The axis of a rotation (a unit quaternion of either sign), as long as its angle in radians,
/// [0, pi].
Eigen::Vector3d ToRotationVector(Eigen::Quaterniond rotation);

}  // namespace ossa::recon
