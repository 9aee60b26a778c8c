#pragma once
#include <optional>

#include "recon/methods/frame_steps_internal.h"
#include "recon/methods/reconstructor.h"
#include "recon/normalise.h"

namespace ossa::recon {

/// Gross failures, told from motion: what no body does between two frames.
class Plausibility {
 public:
  explicit Plausibility(double slack_m = BestConstants().slack_m) : slack_m_(slack_m) {}
  /// Exchanges left and right back where the sensor exchanged them. Returns the doubt about the
  /// whole person as a factor of trust: 1 none, 0.5 sides exchanged, 0 another body or a jump.
  /// Also judges single joints: see joint_trust.
  double Repair(ReconstructionInput& input);
  /// 1, or little for a joint that just jumped and has not yet stayed where it is.
  const JointWeights& joint_trust() const { return joint_trust_; }
  /// The person is, from this frame on, somewhere else than the last posture: a cut, a lost
  /// stretch, a jump that was waited out. What was filtered until now is past.
  bool elsewhere() const { return elsewhere_; }
  void Remember(const Posture& made, double dt_s);

 private:
  double BelieveAfterAll();
  void JudgeJoints(const TrackedPosture& observed, const Posture& predicted, double dt_s);
  bool SameBones(const TrackedPosture& observed) const;
  bool LooksWrong(const TrackedPosture& observed, size_t joint) const;

  double slack_m_;  // sensors are off by as much without failing
  std::optional<Posture> last_, before_last_;
  Posture suspect_;                // where each jumped joint was last said to be
  JointArray<double> jumped_s_{};  // for how long; 0: it did not
  JointWeights joint_trust_{};
  double body_jumped_s_ = 0.0, exchanged_s_ = 0.0;
  bool elsewhere_ = false;
  FrameSteps steps_;
  double last_dt_s_ = 1.0 / 30.0;
};

}  // namespace ossa::recon
