#pragma once
#include <array>
#include <vector>

#include "recon/filters/lag_filter_internal.h"
#include "recon/gp/linear_filter.h"
#include "recon/methods/reconstructor.h"

namespace ossa::recon {

/// The filter of `best`: all joints of a person, now without lag and once more a frame later.
///
/// Where a LinearFilter was learned of the sensor it is heard; LagFilter goes on beside it and is
/// heard of joints it has no weights for, and until a joint was believed in enough frames, one
/// after the other in the step that was learned of.
class PostureFilter {
 public:
  PostureFilter() = default;
  PostureFilter(const BestConstants& constants, const LinearFilter& linear)
      : lag_(constants.noise_m, constants.acceleration), linear_(linear) {
    Restart();
  }
  /// heard in (0, 1], of each joint, divides its measurement's variance; believed: it is where it
  /// was seen. The estimate for now.
  Posture Step(const Posture& in_camera, double yaw_rad, double dt_s, const JointWeights& heard,
               const std::array<bool, kJointCount>& believed);
  /// What is now thought of the step before.
  const Posture& before() const { return before_; }
  void Restart();

 private:
  void Remember(const Posture& in_camera, double dt_s,
                const std::array<bool, kJointCount>& believed);

  LagFilter lag_;
  LinearFilter linear_;
  std::array<LagFilter, kJointCount> filters_;
  std::vector<Posture> window_;  // frames in the learned step, the newest last
  LinearFilter::Steps steps_{};  // believed, up to the newest frame; -1: it is not
  Posture before_;
};

}  // namespace ossa::recon
