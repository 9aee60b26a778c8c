#include <algorithm>

#include "recon/methods/best/correction_internal.h"

namespace ossa::recon {
namespace {

Posture ToStandardSize(const Posture& in_camera, const FrameState& frame) {
  return Scaled(Normalised(in_camera, frame.placement), 1.0 / frame.scale);
}

}  // namespace

void Correction::Observe(const Posture& in_camera, const FrameState& frame, double dt_s) {
  if (learned_.empty()) return;
  constexpr double kMemory_s = 20.0;  // by hand: people turn, and walk elsewhere
  averaged_s_ = std::min(averaged_s_ + dt_s, kMemory_s);
  const Posture now = Predict(in_camera, frame);
  for (size_t i = 0; i < kJointCount; ++i) {
    mean_offset_.position_m[i] +=
        dt_s / averaged_s_ * (now.position_m[i] - mean_offset_.position_m[i]);
  }
  if (!of_window_.empty())
    history_.Add(frame.time_s, CorrectionFeature(ToStandardSize(in_camera, frame)));
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
  const Posture scaled = ToStandardSize(in_camera, frame);
  const Posture by_posture = learned_.Offsets(scaled);
  if (of_window_.empty()) return by_posture;
  Posture mean = of_window_.Offsets(history_.WindowAt(frame.time_s, CorrectionFeature(scaled)));
  for (size_t i = 0; i < kJointCount; ++i) {
    mean.position_m[i] = 0.5 * (mean.position_m[i] + by_posture.position_m[i]);
  }
  return mean;
}

void Correction::Reset() {
  mean_offset_ = Posture();
  averaged_s_ = 0.0;
  history_.Clear();
}

}  // namespace ossa::recon
