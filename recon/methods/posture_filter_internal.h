#pragma once
#include <array>
#include <vector>

#include "recon/filters/lag_filter_internal.h"
#include "recon/methods/reconstructor.h"
#include "recon/models/linear_filter.h"

namespace ossa::recon {

/// What is known of the joints of a frame that is to be filtered.
struct Heard {
  JointWeights weights{};       // in (0, 1]: they divide a measurement's variance
  JointArray<bool> believed{};  // it is where it was seen
  JointArray<bool> seen{};      // believed or not, it is not merely held
};

/// The filter of `best`: all joints of a person, now without lag and once more a frame later.
///
/// Where a LinearFilter was learned of the sensor it is heard; LagFilter goes on beside it and is
/// heard of joints it has no weights for, and until a joint was believed (for weights of pulls:
/// seen, because they know themselves what to make of a gross error) in enough frames, one after
/// the other in the step that was learned of.
class PostureFilter {
 public:
  PostureFilter() = default;
  PostureFilter(const BestConstants& constants, const LinearFilter& linear)
      : lag_(constants.noise_m, constants.acceleration), linear_(linear) {
    Restart();
  }
  /// The estimate for now.
  Posture Step(const Posture& in_camera, double yaw_rad, double dt_s, const Heard& heard);
  /// What is now thought of the step before.
  const Posture& before() const { return before_; }
  void Restart();
  /// Whether weights of pulls were heard of a joint in the last step.
  bool HeardPulls(size_t joint) const {
    return seen_[joint] >= LinearFilter::kFewest && linear_.Pulls(LinearFilter::kNow, joint);
  }

 private:
  void Remember(const Posture& in_camera, double dt_s, const Heard& heard);
  void Forget();

  LagFilter lag_;
  LinearFilter linear_;
  JointArray<LagFilter> filters_;
  std::vector<Posture> window_;  // frames in the learned step, the newest last
  LinearFilter::Steps steps_{};  // believed, up to the newest frame; -1: it is not
  LinearFilter::Steps seen_{};   // the same of what was seen
  Posture before_;
};

}  // namespace ossa::recon
