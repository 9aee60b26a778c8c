#pragma once
#include <optional>

#include "recon/filters/frame_steps.h"
#include "recon/methods/reconstructor.h"
#include "recon/normalise.h"

namespace ossa::recon {

// Constants: by hand, from limits of human motion with a margin.

/// What a body does between two frames: limits of human motion with a margin, checked on the
/// recordings whose jumps and snapped hands `ossa experiment sdk` counts (KinectGait, KERAAL,
/// Microsoft's).
struct GrossFailureOptions {
  double slack_m =
      BestConstants().failure_slack_m;  // sensors are off by as much without failing, > 0
  double patience_s = 0.1;              // a jump that stays as long is believed after all
  double own_patience_s = 0.04;         // ... of a body with the person's own bones
  double sides_patience_s = 0.6;        // sides exchanged for longer: the person turned, unseen
  double body_slack_m = 0.1;            // beside slack_m, of a whole body
  double body_speed = 5.0;              // m/s of a whole body
  double cut_speed = 4.5;               // m/s of half of all joints: rather a cut than a move
  double limb_speed = 8.0;              // m/s of a hand: a thrower's
  double mirrored_ratio = 0.4;  // sides are exchanged if the mirrored body is nearer by this factor
  double jump_trust = 0.05;     // weight of a joint that just jumped, [0, 1]
  double wrong_bone = 0.35;     // share of a bone by which no measurement errs
  double same_bone = 0.1;       // share by which the person's own does
  double same_place_m = 0.1;    // a hand within this of the other one has snapped to it
};

/// Stage 1 of `best`. Gross failures, told from motion: what no body does between two frames.
class GrossFailures {
 public:
  explicit GrossFailures(double slack_m = BestConstants().failure_slack_m) {
    options_.slack_m = slack_m;
  }
  /// Exchanges left and right back where the sensor exchanged them. Returns the trust in the whole
  /// person: 1 usually, 0.5 sides exchanged, 0 another body or a jump.
  /// Also judges single joints: see joint_trust.
  double Repair(ReconstructionInput& input);
  /// 1, or little for a joint that just jumped and has not yet stayed where it is.
  const JointWeights& joint_trust() const { return joint_trust_; }
  /// The person is, from this frame on, somewhere else than the last posture: a cut, a lost
  /// stretch, a jump that was waited out. What was filtered until now is past.
  bool elsewhere() const { return elsewhere_; }
  /// Of the whole person in the latest frame.
  GrossFailure failure() const { return failure_; }
  void Remember(const Posture& made, double dt_s);

 private:
  double BeginAnew();
  double AcceptAfterAll();
  /// Where the joints are expected so long after the last posture.
  Posture Predict(double step_s) const;
  /// Farther than a body gets.
  bool IsBeyondReach(double distance_m, double step_s) const;
  void JudgeJoints(const TrackedPosture& observed, const Posture& predicted, double dt_s);
  bool SameBones(const TrackedPosture& observed) const;
  bool LooksWrong(const TrackedPosture& observed, size_t joint) const;

  GrossFailureOptions options_;
  std::optional<Posture> last_, before_last_;
  Posture suspect_;                // where each jumped joint was last said to be
  JointArray<double> jumped_s_{};  // for how long; 0: it did not
  JointWeights joint_trust_{};
  double body_jumped_s_ = 0.0, exchanged_s_ = 0.0;
  bool elsewhere_ = false;
  GrossFailure failure_ = GrossFailure::kNone;
  FrameSteps steps_;
  double last_dt_s_ = 1.0 / 30.0;
};

}  // namespace ossa::recon
