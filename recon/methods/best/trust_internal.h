#pragma once
#include "recon/methods/best/sensor_traits_internal.h"
#include "recon/methods/prepared_posture_internal.h"

namespace ossa::recon {

// Constants: by hand unless stated otherwise.

/// Thresholds of the trust in a joint; all weights in [0, 1].
struct TrustOptions {
  // Trust in a limb joint rises from 0 to 1 over this range of its kinematic term (Shum 2013, eq.
  // 6), starting at the least value: bone lengths of real sensors vary by up to a third during a
  // movement; at half they are wrong.
  double least_kinematics = 0.5, kinematics_range = 0.2;
  double trusted = 0.5;       // trust from which a joint keeps its observed position
  double interpolated = 0.6;  // trust of an interpolated joint, as a share of that of the two ends
  // Bones of joints that the sensor does not provide are measured from neighbouring joints if
  // enough joints are trusted, with the smallest weight that counts.
  double interpolated_bones = 0.51;
  int fewest_trusted = 8;
};

/// Inputs of the trust besides the frame itself.
struct TrustInputs {
  double body = 1.0;           // in the whole person: 0 for another body (GrossFailures::Repair)
  JointWeights jumps{};        // in single joints that jumped (GrossFailures::joint_trust)
  JointArray<bool> missing{};  // provided by the sensor, but absent in this frame
};

/// The trust in each joint's observed position, in [0, 1] (for interpolated joints up to 0.6): the
/// terms of Shum 2013 without the window of eq. 8, which would lower a joint's trust for six
/// frames.
JointWeights ComputeTrust(const PreparedPosture& prepared, const TrackedPosture& observed,
                          const SensorTraits& sensor, const TrustInputs& inputs,
                          const TrustOptions& options = {});

/// Whether an absent joint is interpolated between its two neighbours. An ankle is, only if the
/// sensor never provides one: its foot is then at the ankle. Otherwise a foot sticks out from that
/// line.
bool IsInterpolated(const PreparedPosture& prepared, const JointArray<bool>& missing, size_t joint);

/// Weights with which the frame's bones are measured.
JointWeights TrustInBones(const PreparedPosture& prepared, const JointWeights& trust,
                          const TrustOptions& options = {});

/// HipCenter, Spine, ShoulderCenter: their location inside the trunk is a convention of each
/// sensor.
constexpr bool IsInTrunk(size_t joint) { return joint <= Index(Joint::kShoulderCenter); }
/// Whether the joint is beyond a shoulder or a hip.
constexpr bool IsInLimb(size_t joint) { return joint > 0 && !IsInTrunk(ParentOf(joint)); }

}  // namespace ossa::recon
