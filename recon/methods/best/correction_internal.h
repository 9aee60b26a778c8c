#pragma once
#include "recon/methods/best/frame_state_internal.h"
#include "recon/models/pose_correction.h"
#include "recon/models/window_correction.h"

namespace ossa::recon {

/// Stage 5 of `best`: subtracts the sensor's learned systematic error of the whole posture. The
/// part of an offset that is constant over postures belongs to the person and to this sensor's view
/// of the person; it is known more accurately than the part that varies with posture.
class Correction {
 public:
  Correction() = default;
  /// `posture_share`: share of the varying part that is applied, in [0, 1].
  Correction(PoseCorrection learned, WindowCorrection of_window, double posture_share)
      : learned_(std::move(learned)),
        of_window_(std::move(of_window)),
        posture_share_(posture_share) {}

  /// Updates the person's mean offset with this frame.
  void Observe(const Posture& in_camera, const FrameState& frame, double dt_s);
  /// The corrected posture, camera space.
  Posture Apply(const Posture& in_camera, const FrameState& frame) const;
  /// Forgets the person.
  void Reset();

 private:
  Posture Predict(const Posture& in_camera, const FrameState& frame) const;

  PoseCorrection learned_;
  WindowCorrection of_window_;  // may be empty
  FeatureHistory history_;
  double posture_share_ = 0.0;
  Posture mean_offset_;      // this person's, normalised and scaled
  double averaged_s_ = 0.0;  // averaging time so far
};

}  // namespace ossa::recon
