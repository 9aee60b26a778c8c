#pragma once
#include <array>
#include <vector>

#include "recon/filters/lag_filter_internal.h"
#include "recon/methods/reconstructor.h"
#include "recon/models/linear_filter.h"

namespace ossa::recon {

/// What is known of the joints of a frame that is to be filtered.
struct FilterMask {
  JointWeights weights{};       // in (0, 1]: they divide a measurement's variance
  JointArray<bool> trusted{};   // it is where it was seen
  JointArray<bool> observed{};  // trusted or not, it is not merely held
};

/// Stage 4 of `best`: all joints of a person, now without lag and once more a frame later.
///
/// Where a LinearFilter was learned of the sensor its estimate is taken; LagFilter goes on beside
/// it and serves for joints that have no learned weights, and until a joint was trusted (for
/// weights of influence: observed, because they weigh a gross error themselves) in enough frames,
/// one after the other in the step that was learned of.
class PostureFilter {
 public:
  PostureFilter() = default;
  PostureFilter(const BestConstants& constants, const LinearFilter& linear)
      : lag_(
            LagFilterOptions{.noise_m = constants.noise_m, .acceleration = constants.acceleration}),
        linear_(linear) {
    Restart();
  }
  /// The estimate for now.
  Posture Step(const Posture& in_camera, double yaw_rad, double dt_s, const FilterMask& mask);
  /// What is now thought of the step before.
  const Posture& before() const { return before_; }
  void Restart();
  /// Whether a joint's estimate came from learned weights of influence in the last step.
  bool UsedInfluence(size_t joint) const {
    return observed_[joint] >= LinearFilter::kFewest &&
           linear_.Influences(LinearFilter::kNow, joint);
  }

 private:
  void Remember(const Posture& in_camera, double dt_s, const FilterMask& mask);
  void Forget();

  LagFilter lag_;
  LinearFilter linear_;
  JointArray<LagFilter> filters_;
  std::vector<Posture> window_;     // frames in the learned step, the newest last
  LinearFilter::Steps trusted_{};   // steps up to the newest frame; -1: it is not trusted
  LinearFilter::Steps observed_{};  // the same of what was observed
  Posture before_;
};

}  // namespace ossa::recon
