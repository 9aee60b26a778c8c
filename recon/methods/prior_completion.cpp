#include <algorithm>

#include "recon/methods/prior_completion_internal.h"

namespace ossa::recon {
namespace {

// Standard deviation of a joint that is fully trusted; of one trusted by half it is twice that.
constexpr double kSound_m = 0.02;
constexpr double kLeastTrust = 0.02;  // a metre: as good as not seen
// Where no hip is seen, the root's place is a guess from the joints that are.
constexpr double kGuessedRoot_m = 0.3;

}  // namespace

Posture PriorCompletion::Step(const PreparedPosture& prepared, const JointWeights& trust,
                              const std::optional<Posture>& before, const BoneLengths& lengths_m) {
  PriorObservation observation;
  observation.lengths_m = lengths_m;
  if (prepared.restarted) doubting_ = false;
  if (!doubting_) {
    filter_.Reset();
    if (before && !prepared.restarted) {
      observation.seen = Normalised(*before, {before->position_m[0], prepared.placement.yaw_rad});
      observation.sd_m.fill(kSound_m);
      filter_.Step(0.0, observation);
    }
    doubting_ = true;
  }
  observation.seen = Normalised(prepared.in_camera, prepared.placement);
  for (size_t i = 0; i < kJointCount; ++i) {
    const bool seen = prepared.present[i] > 0.0 && trust[i] > kLeastTrust;
    observation.sd_m[i] = seen ? kSound_m / std::min(1.0, trust[i]) : 0.0;
  }
  observation.root_sd_m = prepared.present[0] + prepared.between[0] > 0.0
                              ? kSound_m / std::clamp(trust[0], kLeastTrust, 1.0)
                              : kGuessedRoot_m;
  return Placed(filter_.Step(prepared.dt_s, observation), prepared.placement);
}

}  // namespace ossa::recon
