#pragma once
#include <optional>

#include "recon/methods/frame_steps_internal.h"
#include "recon/methods/reconstructor.h"
#include "recon/normalise.h"
#include "recon/refine/bone_measure.h"
#include "recon/reliability.h"

namespace ossa::recon {

/// The person's bone lengths, kept constant from the first good frame on: the standing or T-posed
/// person that tracking starts with (Shum 2013 fig. 2), left and right averaged, each bone within a
/// quarter of a body of that size. With a close look, which judges them in each frame, they settle
/// in the first second. Measured anew when the body has another size for a second, which is another
/// person; and, at looks that become rarer, when the bones seen until then are typically others: to
/// these they grow in half a second. Bones that are known stay.
class BodySize {
 public:
  BodySize() = default;
  /// `as_measured`: bones may be as far from the standard ones as they like; a foot may end in the
  /// ankle where a sensor has only one of the two.
  explicit BodySize(bool as_measured) : as_measured_(as_measured) {}
  /// Bones are expected in these proportions to the standard ones (0: nothing is expected): the
  /// lengths taken lie between what is measured, in one frame, and what the body's size tells.
  /// `share`: of what the size tells.
  void Expect(const BoneLengths& proportions, double share) {
    proportions_ = proportions;
    expected_ = share;
  }
  /// `expected_scale`: what the proportions are multiplied with; 0: the measured size. `judged`:
  /// the bones as a close look judges them in this frame, which goes before what lies between
  /// joints; their mean settles in the first second.
  void Observe(const Posture& in_camera, const JointWeights& trust, double expected_scale = 0.0,
               const std::optional<BoneLengths>& judged = std::nullopt);
  /// The person's bones were measured before: these stay, whatever is observed.
  void Know(const BoneLengths& lengths_m);
  const BoneLengths& lengths_m() const { return lengths_m_; }
  /// What would be taken now, by all that was observed: lengths_m() changes rarely.
  BoneLengths Latest() const { return known_ ? lengths_m_ : Taken(); }
  bool locked() const { return locked_; }
  /// Over the standard body, as a whole.
  double scale() const { return scale_; }

 private:
  static constexpr int kPatience_frames = 30;    // another size for so long is another person
  static constexpr int kSettled_frames = 30;     // judged bones are the mean of so many
  static constexpr int kFirstLook_frames = 105;  // sooner, a pose is taken for a body
  static constexpr int kGrow_frames = 15;        // a bone that grew at once would throw its joints
  /// Median length of each bone over the frames seen; of a pair of bones at its left one.
  struct TypicalBones {
    void Add(const BoneLengths& measured, const JointWeights& trust);
    BoneLengths length_m{};
    JointArray<int> samples{};
    int frames = 0;
  };

  void Reconsider();
  void Grow();
  BoneLengths Taken() const;

  bool as_measured_ = false;
  bool known_ = false;
  BoneLengths lengths_m_ = StandardBoneLengths();
  BoneLengths grow_from_m_{}, grow_to_m_{};
  int grown_frames_ = kGrow_frames;
  TypicalBones typical_;
  JudgedBones judged_;
  BoneLengths proportions_{};
  double expected_ = 0.0;
  double expected_scale_ = 0.0;
  double scale_ = 1.0;
  bool locked_ = false;
  int other_size_frames_ = 0;
  int next_look_ = kFirstLook_frames;
};

/// One observation made ready for the methods: complete, finite, normalised.
struct PreparedPosture {
  Posture in_camera;           // 20 finite joints; absent ones filled in from the body's structure
  Placement placement;         // camera from normalised
  Posture normalised;          // of the standard size
  Posture scaled;              // normalised, all bones as observed, divided by `scale`
  double scale = 1.0;          // of this person over the standard body
  JointWeights reliability{};  // R_i; 0 for joints that were not observed
  Reliability terms;           // what R_i was made of, this frame
  JointWeights present{};      // 1 for a finite joint that is tracked or inferred
  JointWeights between{};      // 1 for an absent joint that lies between two present ones
  double dt_s = 1.0 / 30.0;    // since the frame before, clamped to [5 ms, 0.5 s]
  bool restarted = true;       // no step from the frame before (FrameSteps): history means nothing
};

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

  ReliabilityEstimator estimator_;
  std::optional<BoneLengths> bones_m_;
  BodySize size_;
  std::optional<Posture> last_in_camera_;
  double last_yaw_rad_ = 3.14159265358979323846;  // a person faces the camera until seen otherwise
  FrameSteps steps_;
  bool started_ = false;
};

/// A joint that lies nearly on the line of two others: p = (1 - share) a + share b.
struct BetweenTwo {
  Joint joint, a, b;
  double share;
};

/// Shares measured on the standard body; the spine after the ends it depends on.
constexpr std::array<BetweenTwo, 7> kBetweenTwo = {
    {{Joint::kShoulderCenter, Joint::kShoulderLeft, Joint::kShoulderRight, 0.5},
     {Joint::kHipCenter, Joint::kHipLeft, Joint::kHipRight, 0.5},
     {Joint::kSpine, Joint::kHipCenter, Joint::kShoulderCenter, 0.36},
     {Joint::kWristLeft, Joint::kElbowLeft, Joint::kHandLeft, 0.83},
     {Joint::kWristRight, Joint::kElbowRight, Joint::kHandRight, 0.83},
     {Joint::kAnkleLeft, Joint::kKneeLeft, Joint::kFootLeft, 0.93},
     {Joint::kAnkleRight, Joint::kKneeRight, Joint::kFootRight, 0.93}}};

/// Absent joints from present ones: midpoints of hips and shoulders, the spine between, wrists
/// from elbow and hand, the others by the last posture (or the standard stance) hung on the nearest
/// present ancestor. `present` says which are believed; every joint comes back finite.
/// `between`, where asked for, tells which lie on the line of two present ones.
Posture Completed(const Posture& in_camera, const JointWeights& present, const Posture& model,
                  JointWeights* between = nullptr);

}  // namespace ossa::recon
