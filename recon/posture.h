#pragma once
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>

#include "recon/skeleton.h"

namespace ossa::recon {

/// 20 joint positions, metres, one per Joint in enum order. The frame (camera space, world, or
/// normalised) is said by the name of the variable that holds it.
struct Posture {
  std::array<Eigen::Vector3d, kJointCount> position_m;

  Posture() { position_m.fill(Eigen::Vector3d::Zero()); }
  Eigen::Vector3d& operator[](Joint j) { return position_m[static_cast<size_t>(j)]; }
  const Eigen::Vector3d& operator[](Joint j) const { return position_m[static_cast<size_t>(j)]; }
};

/// As the Kinect SDK's JointTrackingState. A not-tracked joint's position means nothing.
enum class TrackingState { kNotTracked, kInferred, kTracked };

/// What a sensor or a file says of one person at one time.
struct TrackedPosture {
  Posture posture;
  std::array<TrackingState, kJointCount> state{};  // starts kNotTracked
  std::array<double, kJointCount> confidence{};    // [0, 1]; the tracker's own trust in each joint
};

/// Orientation of each joint's bone as the Kinect SDK defines it: world (camera) from bone, the
/// bone's y axis along the bone from parent to joint. Identity where unknown.
using JointOrientations = std::array<Eigen::Quaterniond, kJointCount>;

/// Lengths of the 19 bones, metres; entry i is the bone that ends in joint i, entry 0 unused (0).
using BoneLengths = std::array<double, kJointCount>;

BoneLengths BoneLengthsOf(const Posture& posture);

}  // namespace ossa::recon
