#include <algorithm>

#include "recon/methods/best/correction_internal.h"

namespace ossa::recon {

void Correction::Observe(const Posture& in_camera, const FrameState& frame, double dt_s) {
  if (learned_.empty()) return;
  constexpr double kMemory_s = 20.0;  // by hand: people turn, and walk elsewhere
  averaged_s_ = std::min(averaged_s_ + dt_s, kMemory_s);
  const Posture now = Predict(in_camera, frame);
  for (size_t i = 0; i < kJointCount; ++i) {
    mean_offset_.position_m[i] +=
        dt_s / averaged_s_ * (now.position_m[i] - mean_offset_.position_m[i]);
  }
}

Posture Correction::Apply(const Posture& in_camera, const FrameState& frame) const {
  if (learned_.empty()) return in_camera;
  Posture offset = Predict(in_camera, frame);
  for (size_t i = 0; i < kJointCount; ++i) {
    const Eigen::Vector3d& mean = mean_offset_.position_m[i];
    offset.position_m[i] = mean + posture_share_ * (offset.position_m[i] - mean);
  }
  const Placement turn{Eigen::Vector3d::Zero(), frame.placement.yaw_rad};
  offset = Placed(Scaled(offset, frame.scale), turn);
  Posture out = in_camera;
  for (size_t i = 0; i < kJointCount; ++i) out.position_m[i] += offset.position_m[i];
  return out;
}

Posture Correction::Predict(const Posture& in_camera, const FrameState& frame) const {
  return learned_.Offsets(Scaled(Normalised(in_camera, frame.placement), 1.0 / frame.scale));
}

void Correction::Reset() {
  mean_offset_ = Posture();
  averaged_s_ = 0.0;
}

}  // namespace ossa::recon
