#pragma once
#include <optional>

#include "recon/filters/frame_steps.h"
#include "recon/methods/body_size_internal.h"
#include "recon/methods/reconstructor.h"
#include "recon/normalise.h"
#include "recon/reliability.h"

namespace ossa::recon {

/// An observation prepared for the methods: complete, finite, normalised.
struct PreparedPosture {
  Posture in_camera;            // 20 finite joints; absent ones are completed
  Placement placement;          // camera from normalised
  Posture normalised;           // at the standard size
  Posture scaled;               // normalised, with observed bones, divided by `scale`
  double scale = 1.0;           // this person's size relative to the standard body
  JointWeights reliability{};   // R_i; 0 for unobserved joints
  Reliability terms;            // the terms of R_i in this frame
  JointWeights present{};       // 1 for a finite joint that is tracked or inferred
  JointWeights interpolated{};  // 1 for an absent joint that lies between two present ones
  double dt_s = 1.0 / 30.0;     // since the frame before, clamped to [5 ms, 0.5 s]
  bool restarted = true;  // no time step from the frame before (FrameSteps): history is invalid
};

/// 1 for a joint that was observed, or interpolated between two observed ones; else 0.
JointWeights SeenJoints(const PreparedPosture& prepared);

/// The per-person state that all methods share.
class Person {
 public:
  /// `bones_m`: the person's bones, if known.
  explicit Person(const ReliabilityOptions& options = {},
                  const std::optional<BoneLengths>& bones_m = std::nullopt)
      : estimator_(options), bones_m_(bones_m), size_(FreshSize()) {}
  PreparedPosture Prepare(const ReconstructionInput& input);
  /// Transforms a normalised posture of the standard size to camera space, with this person's
  /// bones.
  Posture InCamera(const Posture& normalised, const PreparedPosture& prepared) const;
  /// Stores the result of the frame: the next frame's absent joints are completed from it.
  void Remember(const Posture& in_camera, const PreparedPosture& prepared);
  void Reset();
  const BodySize& size() const { return size_; }
  const std::optional<Posture>& last_in_camera() const { return last_in_camera_; }

 private:
  BodySize FreshSize() const;
  // What absent joints are completed from: the posture before, at first the standard stance.
  Posture ModelOf(const Posture& seen, const JointWeights& present) const;

  ReliabilityEstimator estimator_;
  std::optional<BoneLengths> bones_m_;
  BodySize size_;
  std::optional<Posture> last_in_camera_;
  double last_yaw_rad_ = 3.14159265358979323846;  // initially facing the camera
  FrameSteps steps_;
  bool started_ = false;
};

/// A joint nearly on the line between two others: p = (1 - share) a + share b.
struct InterpolatedJoint {
  Joint joint{}, a{}, b{};
  double share = 0;
};

/// Shares measured on the standard body; the spine comes after the joints it depends on.
constexpr std::array<InterpolatedJoint, 7> kInterpolatedJoints = {
    {{Joint::kShoulderCenter, Joint::kShoulderLeft, Joint::kShoulderRight, 0.5},
     {Joint::kHipCenter, Joint::kHipLeft, Joint::kHipRight, 0.5},
     {Joint::kSpine, Joint::kHipCenter, Joint::kShoulderCenter, 0.36},
     {Joint::kWristLeft, Joint::kElbowLeft, Joint::kHandLeft, 0.83},
     {Joint::kWristRight, Joint::kElbowRight, Joint::kHandRight, 0.83},
     {Joint::kAnkleLeft, Joint::kKneeLeft, Joint::kFootLeft, 0.93},
     {Joint::kAnkleRight, Joint::kKneeRight, Joint::kFootRight, 0.93}}};

/// Completes absent joints: midpoints of hips and shoulders, the spine between them, wrists from
/// elbow and hand; others are propagated from the nearest present ancestor with their offset in
/// `model`, the last posture or the standard stance. `present` marks the trusted joints; all
/// returned joints are finite. `interpolated`, if given, receives which joints lie between two
/// present ones.
Posture Completed(const Posture& in_camera, const JointWeights& present, const Posture& model,
                  JointWeights* interpolated = nullptr);

}  // namespace ossa::recon
