#pragma once
#include <optional>

#include "recon/filters/frame_steps.h"
#include "recon/methods/body_size_internal.h"
#include "recon/methods/reconstructor.h"
#include "recon/normalise.h"
#include "recon/reliability.h"

namespace ossa::recon {

/// One observation made ready for the methods: complete, finite, normalised.
struct PreparedPosture {
  Posture in_camera;            // 20 finite joints; absent ones filled in from the body's structure
  Placement placement;          // camera from normalised
  Posture normalised;           // of the standard size
  Posture scaled;               // normalised, all bones as observed, divided by `scale`
  double scale = 1.0;           // of this person over the standard body
  JointWeights reliability{};   // R_i; 0 for joints that were not observed
  Reliability terms;            // what R_i was made of, this frame
  JointWeights present{};       // 1 for a finite joint that is tracked or inferred
  JointWeights interpolated{};  // 1 for an absent joint that lies between two present ones
  double dt_s = 1.0 / 30.0;     // since the frame before, clamped to [5 ms, 0.5 s]
  bool restarted = true;        // no step from the frame before (FrameSteps): history means nothing
};

/// 1 for a joint that was measured or lies between two that were, else 0.
JointWeights SeenJoints(const PreparedPosture& prepared);

/// What every method needs to remember of one person.
class Person {
 public:
  /// `bones_m`: the person's bones where they are known.
  explicit Person(const ReliabilityOptions& options = {},
                  const std::optional<BoneLengths>& bones_m = std::nullopt)
      : estimator_(options), bones_m_(bones_m), size_(FreshSize()) {}
  PreparedPosture Prepare(const ReconstructionInput& input);
  /// A normalised posture of the standard size back in the camera, with this person's bones.
  Posture InCamera(const Posture& normalised, const PreparedPosture& prepared) const;
  /// Tells the person what was made of the frame: the next frame's absent joints start from it.
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
  double last_yaw_rad_ = 3.14159265358979323846;  // a person faces the camera until seen otherwise
  FrameSteps steps_;
  bool started_ = false;
};

/// A joint that lies nearly on the line of two others: p = (1 - share) a + share b.
struct InterpolatedJoint {
  Joint joint, a, b;
  double share;
};

/// Shares measured on the standard body; the spine after the ends it depends on.
constexpr std::array<InterpolatedJoint, 7> kInterpolatedJoints = {
    {{Joint::kShoulderCenter, Joint::kShoulderLeft, Joint::kShoulderRight, 0.5},
     {Joint::kHipCenter, Joint::kHipLeft, Joint::kHipRight, 0.5},
     {Joint::kSpine, Joint::kHipCenter, Joint::kShoulderCenter, 0.36},
     {Joint::kWristLeft, Joint::kElbowLeft, Joint::kHandLeft, 0.83},
     {Joint::kWristRight, Joint::kElbowRight, Joint::kHandRight, 0.83},
     {Joint::kAnkleLeft, Joint::kKneeLeft, Joint::kFootLeft, 0.93},
     {Joint::kAnkleRight, Joint::kKneeRight, Joint::kFootRight, 0.93}}};

/// Absent joints from present ones: midpoints of hips and shoulders, the spine between, wrists
/// from elbow and hand, the others propagated from the nearest present ancestor as they lie to it
/// in `model`, the last posture or the standard stance. `present` says which are believed; every
/// joint comes back finite. `interpolated`, where asked for, tells which lie on the line of two
/// present ones.
Posture Completed(const Posture& in_camera, const JointWeights& present, const Posture& model,
                  JointWeights* interpolated = nullptr);

}  // namespace ossa::recon
