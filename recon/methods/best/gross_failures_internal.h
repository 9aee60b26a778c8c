#pragma once
#include <optional>

#include "recon/filters/frame_steps.h"
#include "recon/methods/reconstructor.h"
#include "recon/normalise.h"

namespace ossa::recon {

// Constants: by hand, from limits of human motion with a margin.

/// Limits of a body's motion between two frames, with a margin, checked on the recordings whose
/// jumps and snapped hands `ossa experiment sdk` counts (KinectGait, KERAAL, Microsoft's).
struct GrossFailureOptions {
  double slack_m = BestConstants().failure_slack_m;  // normal sensor error, > 0
  double patience_s = 0.1;                           // a jump that persists this long is accepted
  double own_patience_s = 0.04;                      // ... for a body with the person's own bones
  double sides_patience_s = 0.6;  // sides exchanged for longer: the person turned unobserved
  double body_slack_m = 0.1;      // of a whole body, in addition to slack_m
  double body_speed = 5.0;        // m/s, of a whole body
  double cut_speed = 4.5;         // m/s, of half of all joints: more likely a cut than a movement
  double limb_speed = 8.0;        // m/s, of a hand: a thrower's
  double mirrored_ratio = 0.4;    // sides are exchanged if that reduces the distance by this factor
  double jump_trust = 0.05;       // weight of a joint that has just jumped, [0, 1]
  double wrong_bone = 0.35;       // error no measurement has, share of a bone's length
  double same_bone = 0.1;         // error of the person's own bones, share of the length
  double same_place_m = 0.1;      // distance of the hands when one has snapped to the other
};

/// Stage 1 of `best`: detects gross failures by motion that is impossible between two frames.
class GrossFailures {
 public:
  explicit GrossFailures(double slack_m = BestConstants().failure_slack_m) {
    options_.slack_m = slack_m;
  }
  /// Swaps left and right back if the sensor exchanged them, and judges single joints (see
  /// joint_trust). Returns the trust in the whole person: usually 1; 0.5 if sides were exchanged; 0
  /// for another body or a jump.
  double Repair(ReconstructionInput& input);
  /// 1, or jump_trust for a joint that has just jumped and has not stayed yet.
  const JointWeights& joint_trust() const { return joint_trust_; }
  /// Whether the person is at a new place from this frame on: a cut, a gap, or a jump that was
  /// waited out. Filter state from before is invalid.
  bool elsewhere() const { return elsewhere_; }
  /// Failure of the whole person in the latest frame.
  GrossFailure failure() const { return failure_; }
  void Remember(const Posture& made, double dt_s);

 private:
  double Restart();
  double AcceptPersistentFailure();
  /// Predicted joints `step_s` after the last posture.
  Posture Predict(double step_s) const;
  /// Whether a body cannot move that far.
  bool IsBeyondReach(double distance_m, double step_s) const;
  void JudgeJoints(const TrackedPosture& observed, const Posture& predicted, double dt_s);
  bool SameBones(const TrackedPosture& observed) const;
  bool LooksWrong(const TrackedPosture& observed, size_t joint) const;

  GrossFailureOptions options_;
  std::optional<Posture> last_, before_last_;
  Posture suspect_;                // last observed position of each jumped joint
  JointArray<double> jumped_s_{};  // time since its jump; 0: no jump
  JointWeights joint_trust_{};
  double body_jumped_s_ = 0.0, exchanged_s_ = 0.0;
  bool elsewhere_ = false;
  GrossFailure failure_ = GrossFailure::kNone;
  FrameSteps steps_;
  double last_dt_s_ = 1.0 / 30.0;
};

}  // namespace ossa::recon
