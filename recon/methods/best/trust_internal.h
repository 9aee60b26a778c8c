#pragma once
#include "recon/methods/best/sensor_traits_internal.h"
#include "recon/methods/prepared_posture_internal.h"

namespace ossa::recon {

// Constants: by hand where nothing else is said.

/// Thresholds of the trust in a joint; all weights in [0, 1].
struct TrustOptions {
  // Trust in a limb's joint rises from 0 to 1 over a range of its kinematic term from the least on
  // (Shum 2013, eq. 6): bones of real sensors are off by up to a third in the course of a move; by
  // half they are wrong.
  double least_kinematics = 0.5, kinematics_range = 0.2;
  double trusted = 0.5;       // from this trust on a joint stays where it is seen
  double interpolated = 0.6;  // share of its ends' trust for a joint on the line between two
  // The bones of joints that the sensor does not have are measured by the joints around them: they
  // count, with the least weight that counts at all, where so many joints are trusted.
  double interpolated_bones = 0.51;
  int fewest_trusted = 8;
};

/// What of a frame the trust is made of besides the frame itself.
struct TrustInputs {
  double body = 1.0;           // of the whole person: 0 for another body (GrossFailures::Repair)
  JointWeights jumps{};        // of single joints that jumped (GrossFailures::joint_trust)
  JointArray<bool> missing{};  // joints the sensor has, absent in this frame
};

/// How far each joint may be believed to be where it is seen, in [0, 1] (of ends that are
/// interpolated up to 0.6): Shum 2013's terms without the window of eq. 8, which would punish a
/// joint for six frames.
JointWeights ComputeTrust(const PreparedPosture& prepared, const TrackedPosture& observed,
                          const SensorTraits& sensor, const TrustInputs& inputs,
                          const TrustOptions& options = {});

/// Whether an absent joint is taken from the line of the two around it. An ankle only of a sensor
/// that never has one, whose foot is where others have the ankle; a foot beside it stands out.
bool IsInterpolated(const PreparedPosture& prepared, const JointArray<bool>& missing, size_t joint);

/// Trust with which the frame's bones are measured.
JointWeights TrustInBones(const PreparedPosture& prepared, const JointWeights& trust,
                          const TrustOptions& options = {});

/// HipCenter, Spine, ShoulderCenter: where inside the trunk they lie, each sensor defines.
constexpr bool IsInTrunk(size_t joint) { return joint <= Index(Joint::kShoulderCenter); }
/// Beyond a shoulder or a hip.
constexpr bool IsInLimb(size_t joint) { return joint > 0 && !IsInTrunk(ParentOf(joint)); }

}  // namespace ossa::recon
