#pragma once
#include <array>
#include <vector>

#include "recon/filters/lag_filter_internal.h"
#include "recon/methods/reconstructor.h"
#include "recon/models/linear_filter.h"

namespace ossa::recon {

/// What is known about the joints of a frame to be filtered.
struct FilterMask {
  JointWeights weights{};       // in (0, 1]; divide a measurement's variance
  JointArray<bool> trusted{};   // the joint is at its observed position
  JointArray<bool> observed{};  // observed, trusted or not; else held
};

/// Stage 4 of `best`: filters all joints of a person, with an estimate now and a revised one a
/// frame later.
///
/// If a LinearFilter was learned for the sensor, its estimate is used. LagFilter runs in parallel
/// and is used for joints without learned weights, and until a joint has been trusted in enough
/// consecutive frames at the learned frame rate. (Influence weights handle gross errors themselves:
/// for them observed is enough.)
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
  /// The revised estimate of the previous step.
  const Posture& before() const { return before_; }
  void Restart();
  /// Whether the joint's last estimate used learned influence weights.
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
  std::vector<Posture> window_;     // frames at the learned frame rate, newest last
  LinearFilter::Steps trusted_{};   // consecutive trusted steps; -1: not trusted
  LinearFilter::Steps observed_{};  // the same for observed
  Posture before_;
};

}  // namespace ossa::recon
