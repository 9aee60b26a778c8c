#pragma once
#include "recon/methods/best/frame_state_internal.h"
#include "recon/models/pose_correction.h"
#include "recon/models/window_correction.h"

namespace ossa::recon {

/// Stage 5 of `best`: the sensor's learned systematic error of the whole posture is taken off. What
/// of an offset stays from posture to posture is the person's and this sensor's view of the person;
/// it is known better than what changes with the posture.
class Correction {
 public:
  Correction() = default;
  /// `posture_share`: share taken of what changes with the posture, in [0, 1].
  Correction(PoseCorrection learned, WindowCorrection of_window, double posture_share)
      : learned_(std::move(learned)),
        of_window_(std::move(of_window)),
        posture_share_(posture_share) {}

  /// Averages this frame's offsets into the person's.
  void Observe(const Posture& in_camera, const FrameState& frame, double dt_s);
  /// The posture without its systematic error, camera space.
  Posture Apply(const Posture& in_camera, const FrameState& frame) const;
  /// Forgets the person.
  void Reset();

 private:
  Posture Predict(const Posture& in_camera, const FrameState& frame) const;

  PoseCorrection learned_;
  WindowCorrection of_window_;  // may be empty
  FeatureHistory history_;
  double posture_share_ = 0.0;
  Posture mean_offset_;      // of this person, normalised and scaled
  double averaged_s_ = 0.0;  // for how long
};

}  // namespace ossa::recon
