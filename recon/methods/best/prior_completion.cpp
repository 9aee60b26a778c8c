#include <algorithm>

#include "recon/methods/best/prior_completion_internal.h"

namespace ossa::recon {
namespace {

/// Share of the present joints that are guesses.
double ComputeGuessShare(const PreparedPosture& prepared, const JointWeights& trust,
                         const PriorCompletionOptions& options) {
  double present = 0.0, guesses = 0.0;
  for (size_t i = 0; i < kJointCount; ++i) {
    if (prepared.present[i] == 0.0) continue;
    present += 1.0;
    guesses += trust[i] <= options.guess ? 1.0 : 0.0;
  }
  return present > 0.0 ? guesses / present : 0.0;
}

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
      observation.sd_m.fill(BaseSigma_m(0.0));
      filter_.Step(0.0, observation);
    }
    doubting_ = true;
  }
  observation.seen = Normalised(prepared.in_camera, prepared.placement);
  const double share_of_guesses = ComputeGuessShare(prepared, trust, options_);
  observation.guesses = share_of_guesses > 0.0;
  const double base_sigma_m = BaseSigma_m(share_of_guesses);
  for (size_t i = 0; i < kJointCount; ++i) {
    const bool seen = prepared.present[i] > 0.0 && trust[i] > options_.least_trust;
    observation.sd_m[i] = seen ? base_sigma_m / std::min(1.0, trust[i]) : 0.0;
  }
  observation.root_sd_m = prepared.present[0] + prepared.interpolated[0] > 0.0
                              ? BaseSigma_m(0.0) / std::clamp(trust[0], options_.least_trust, 1.0)
                              : options_.guessed_root_m;
  return Placed(filter_.Step(prepared.dt_s, observation), prepared.placement);
}

}  // namespace ossa::recon
