#include <algorithm>

#include "recon/methods/best/trust_internal.h"

namespace ossa::recon {

JointWeights ComputeTrust(const PreparedPosture& prepared, const TrackedPosture& observed,
                          const SensorTraits& sensor, const TrustInputs& inputs,
                          const TrustOptions& options) {
  JointWeights trust{};
  const Reliability& r = prepared.terms;
  for (size_t i = 0; i < kJointCount; ++i) {
    const double state = observed.state[i] == TrackingState::kTracked ? 1.0 : sensor.inferred_trust;
    const double over = (r.kinematics[i] - options.least_kinematics) / options.kinematics_range;
    const double bones = IsInTrunk(i) ? 1.0 : std::clamp(over, 0.0, 1.0);
    const double surface = sensor.surface_is_known ? 1.0 : r.surface[i];
    trust[i] = prepared.present[i] * state * bones * r.behaviour[i] * surface * r.speed[i] *
               inputs.jumps[i] * inputs.body;
  }
  for (const InterpolatedJoint& line : kInterpolatedJoints) {
    if (!IsInterpolated(prepared, inputs.missing, Index(line.joint))) continue;
    trust[line.joint] = options.interpolated * std::min({trust[line.a], trust[line.b], 1.0});
  }
  return trust;
}

bool IsInterpolated(const PreparedPosture& prepared, const JointArray<bool>& missing,
                    size_t joint) {
  const bool ankle = joint == Index(Joint::kAnkleLeft) || joint == Index(Joint::kAnkleRight);
  return prepared.interpolated[joint] > 0.0 && !(ankle && missing[joint]);
}

JointWeights TrustInBones(const PreparedPosture& prepared, const JointWeights& trust,
                          const TrustOptions& options) {
  const auto trusted =
      std::count_if(trust.begin(), trust.end(), [&](double t) { return t > options.trusted; });
  if (trusted < options.fewest_trusted) return trust;
  JointWeights out = trust;
  for (size_t i = 0; i < kJointCount; ++i) {
    if (prepared.present[i] == 0.0) out[i] = options.interpolated_bones;
  }
  return out;
}

}  // namespace ossa::recon
