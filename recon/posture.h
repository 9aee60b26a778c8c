#pragma once
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>

#include "recon/skeleton.h"

namespace ossa::recon {

/// 20 joint positions, metres, one per Joint in enum order. The variable's name contains the frame
/// (camera space, world, or normalised).
struct Posture {
  JointArray<Eigen::Vector3d> position_m;

  Posture() { position_m.fill(Eigen::Vector3d::Zero()); }
  Eigen::Vector3d& operator[](Joint j) { return position_m[j]; }
  const Eigen::Vector3d& operator[](Joint j) const { return position_m[j]; }
};

/// Index of a joint's x in a vector of all coordinates.
constexpr Eigen::Index FirstCoordinate(size_t joint) {
  return static_cast<Eigen::Index>(3 * joint);
}

/// As the Kinect SDK's JointTrackingState. The position of a joint that is not tracked is
/// meaningless.
enum class TrackingState { kNotTracked, kInferred, kTracked };

/// The observation of one person at one time by a sensor or in a file.
struct TrackedPosture {
  Posture posture;
  JointArray<TrackingState> state{};  // starts kNotTracked
  JointArray<double> confidence{};    // [0, 1], as the tracker reports it
};

/// The posture with left and right joints exchanged.
TrackedPosture SidesExchanged(const TrackedPosture& seen);

/// Orientation of each joint's bone as the Kinect SDK defines it: world (camera) from bone, the
/// bone's y axis along the bone from parent to joint. Identity where unknown.
using JointOrientations = JointArray<Eigen::Quaterniond>;

/// Lengths of the 19 bones, metres; entry i is the bone that ends in joint i, entry 0 unused (0).
using BoneLengths = JointArray<double>;

/// Distances from each joint to its parent, metres; 0 for the root.
BoneLengths MeasureBoneLengths(const Posture& posture);

/// Mean distance to the joints of `target` that are finite, metres; 0 if none is.
double MeanDistance_m(const Posture& posture, const Posture& target);

/// `seen` with its non-finite joints placed relative to their parents as in `whole`.
Posture FilledFrom(const Posture& whole, const Posture& seen);

}  // namespace ossa::recon
