#include "recon/methods/best/posture_filter_internal.h"

#include <algorithm>
#include <optional>

namespace ossa::recon {

void PostureFilter::Restart() {
  filters_.fill(lag_);
  Forget();
}

void PostureFilter::Forget() {
  window_.clear();
  trusted_.fill(-1);
  observed_.fill(-1);
}

void PostureFilter::Remember(const Posture& in_camera, double dt_s, const FilterMask& mask) {
  if (!window_.empty() && !linear_.IsStep(dt_s)) Forget();
  if (window_.size() == LinearFilter::kFrames) window_.erase(window_.begin());
  window_.push_back(in_camera);
  for (size_t i = 0; i < kJointCount; ++i) {
    trusted_[i] = mask.trusted[i] ? trusted_[i] + 1 : -1;
    observed_[i] = mask.observed[i] ? observed_[i] + 1 : -1;
  }
}

Posture PostureFilter::Step(const Posture& in_camera, double yaw_rad, double dt_s,
                            const FilterMask& mask) {
  constexpr int kTakeOver =
      4;  // frames for which a newly trusted joint comes from LagFilter; by hand
  if (!linear_.empty()) Remember(in_camera, dt_s, mask);
  Posture now;
  for (size_t i = 0; i < kJointCount; ++i) {
    now.position_m[i] = filters_[i].Step(in_camera.position_m[i], dt_s, mask.weights[i]);
    before_.position_m[i] = filters_[i].before_m();
    std::optional<std::array<Eigen::Vector3d, LinearFilter::kOutputs>> better_m;
    const auto estimate = [&](LinearFilter::Output output, Eigen::Vector3d& position_m) {
      const int steps = linear_.Influences(output, i) ? observed_[i] : trusted_[i];
      const int ready = steps - LinearFilter::kFewest + 1;
      if (ready < 1 || !linear_.Knows(output, i)) return;
      if (!better_m) better_m = linear_.Estimate(i, window_, trusted_, yaw_rad);
      const double share = std::min(1.0, static_cast<double>(ready) / kTakeOver);
      position_m += share * ((*better_m)[output] - position_m);
    };
    estimate(LinearFilter::kNow, now.position_m[i]);
    estimate(LinearFilter::kBefore, before_.position_m[i]);
  }
  return now;
}

}  // namespace ossa::recon
