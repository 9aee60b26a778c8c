// ossa's own method, the default. Causal; a joint seen well passes nearly unchanged. Where there is
// a depth image the tracker has looked again, closely, at the joints (recon/look). In order:
//   1. whole-person failures (left and right exchanged, a jump to another body) are undone or
//      waited out; single joints that jump are doubted until they stay (gross failures, snapped
//      hands);
//   2. trust of each joint: reliability without the window of eq. 8, which would punish a joint for
//      six frames; softened where good sensors are imprecise anyway (bone lengths);
//   3. joints in doubt are completed: hung on what is seen, as they hung before where the sensor's
//      guesses are fair, else as is to be expected of what was seen until now (recon/models/
//      posture_prior.h) or, without a prior, as plantard-2016 has them in a natural posture;
//   4. a filter a joint weighs by trust, or one that was learned of this sensor; a frame later it
//      says better what it thought (posture_filter_internal.h);
//   5. the learned systematic error of the whole posture is taken off
//   (recon/models/pose_correction.h);
//   6. the person's constant bone lengths are imposed, moving the joints least; a close look judges
//      them frame by frame (recon/refine/bone_measure.h).
#include <algorithm>
#include <cmath>

#include "recon/methods/bone_projection.h"
#include "recon/methods/methods_internal.h"
#include "recon/methods/person_internal.h"
#include "recon/methods/plausibility_internal.h"
#include "recon/methods/posture_filter_internal.h"
#include "recon/methods/prior_completion_internal.h"
#include "recon/models/learned_models.h"

namespace ossa::recon {
namespace {

class Best : public Reconstructor {
 public:
  explicit Best(const ReconstructorOptions& options)
      : options_(options.best),
        constants_(options.best.constants),
        plausibility_(constants_.slack_m) {
    LinearFilter linear;
    if (const auto learned = LoadLearned(options)) {
      correction_ = learned->correction;
      linear = learned->filter;
    }
    bones_m_ = options.bones_m;
    MeasureAnew();
    filter_ = PostureFilter(constants_, linear);
    if (options.prior) {
      expected_.emplace(options.prior);
    } else if (options.database) {
      natural_ = MakePlantard2016(ForCompletion(options));
    }
  }

  ReconstructedPosture Step(const ReconstructionInput& raw) override {
    ReconstructionInput input = raw;
    const double doubt = options_.repair ? plausibility_.Repair(input) : 1.0;  // 1.
    const PreparedPosture prepared = person_.Prepare(input);
    if (prepared.restarted) filter_.Restart();
    FindLost(prepared, input);
    JointWeights trust = Trust(prepared, input, doubt);  // 2.
    Posture target = prepared.in_camera;
    if (doubt == 0.0 && person_.last_in_camera()) {
      target = *person_.last_in_camera();  // somebody else, perhaps: the person stays
    } else if (options_.complete) {
      Complete(prepared, input, trust, target);  // 3.
    }
    if (plausibility_.elsewhere()) filter_.Restart();
    const Posture now = options_.filter ? Filtered(target, prepared, trust) : target;  // 4.
    const Posture& before = options_.filter ? filter_.before() : target;
    Moment moment{doubt > 0.0 ? now : prepared.in_camera, prepared.placement, prepared.scale, trust,
                  prepared.reliability};
    for (size_t i = 0; i < kJointCount; ++i) {
      moment.reliability[i] = std::min(moment.reliability[i], trust[i]);
    }
    RememberOffsets(now, moment, prepared.dt_s);
    const Posture corrected = Corrected(now, moment);  // 5.
    size_.Observe(corrected, TrustOfBones(prepared, trust), prepared.scale, input.bones_m);
    const ReconstructedPosture out = WithBones(corrected, moment);  // 6.
    revised_.reset();
    if (last_ && !prepared.restarted && options_.filter) {
      const Posture& better = plausibility_.elsewhere() ? last_->stands : before;
      revised_ = WithBones(Corrected(better, *last_), *last_);
    }
    last_ = moment;
    // What the next frame is held against has the sensor's errors, as that will have.
    plausibility_.Remember(now, prepared.dt_s);
    person_.Remember(now, prepared);
    return out;
  }

  std::optional<ReconstructedPosture> Revised() const override { return revised_; }

  std::optional<BoneLengths> Bones() const override { return size_.Latest(); }

  void Reset() override {
    person_.Reset();
    plausibility_ = Plausibility(constants_.slack_m);
    MeasureAnew();
    if (natural_) natural_->Reset();
    if (expected_) expected_->Forget();
    had_.fill(false);
    mean_offset_ = Posture();
    offsets_s_ = 0.0;
    last_.reset();
    revised_.reset();
    filter_.Restart();
  }

 private:
  void MeasureAnew() {
    size_ = BodySize(true);
    size_.Expect(correction_.proportions, constants_.expected);
    if (bones_m_) size_.Know(*bones_m_);
  }

  /// What a frame's last steps need to know of it.
  struct Moment {
    Posture stands;  // should the next frame tell nothing of it: what was seen, if it was a jump
    Placement placement;
    double scale = 1.0;
    JointWeights trust{}, reliability{};
  };

  // Where nothing is completed, a joint in doubt enters its filter as a measurement of at most
  // twice the variance.
  static constexpr double kLeastTrust = 0.5;
  // Trust from which on a joint stays where it is seen.
  static constexpr double kSound = 0.5;
  // What lies on the line of two joints is trusted as they are, but for this.
  static constexpr double kBetween = 0.6;

  /// A quarter of the paper's search: joints in doubt are no worse for it in the ten scenarios of
  /// Plantard 2016, and a frame costs half a millisecond less.
  static ReconstructorOptions ForCompletion(ReconstructorOptions options) {
    options.local_pca.steps = 8;
    options.local_pca.samples = 60;
    options.bones_m.reset();  // it has joints where the sensor has them
    return options;
  }

  JointWeights Trust(const PreparedPosture& prepared, const ReconstructionInput& input,
                     double doubt) const {
    JointWeights trust{};
    const Reliability& r = prepared.terms;
    for (size_t i = 0; i < kJointCount; ++i) {
      const double state =
          input.observed.state[i] == TrackingState::kTracked ? 1.0 : GuessesOf(input).trust;
      // Bones of real sensors are off by up to a third in the course of a move; by half they are
      // wrong. Where the trunk's own joints lie, sensors only define, and each differently.
      const double bones = InTrunk(i) ? 1.0 : std::clamp((r.kinematics[i] - 0.5) / 0.2, 0.0, 1.0);
      // A close look has seen what surface there is, and said where behind it the joint is.
      const double surface = options_.looked ? 1.0 : r.surface[i];
      trust[i] = prepared.present[i] * state * bones * r.behaviour[i] * surface * r.speed[i] *
                 (options_.repair ? plausibility_.joint_trust()[i] : 1.0) * doubt;
    }
    for (const BetweenTwo& line : kBetweenTwo) {
      if (!OnLine(prepared, Index(line.joint))) continue;
      trust[line.joint] = kBetween * std::min({trust[line.a], trust[line.b], 1.0});
    }
    return trust;
  }

  /// Whether an absent joint is taken from the line of the two around it. An ankle only of a sensor
  /// that never has one, whose foot is where others have the ankle; a foot beside it stands out.
  bool OnLine(const PreparedPosture& prepared, size_t joint) const {
    const bool ankle = joint == Index(Joint::kAnkleLeft) || joint == Index(Joint::kAnkleRight);
    return prepared.between[joint] > 0.0 && !(ankle && lost_[joint]);
  }

  /// Which joints are absent in this frame, of a sensor that has them. With a depth image none:
  /// there the tracker itself has placed what it does not see.
  void FindLost(const PreparedPosture& prepared, const ReconstructionInput& input) {
    for (size_t i = 0; i < kJointCount; ++i)
      lost_[i] = input.depth == nullptr && had_[i] && prepared.present[i] == 0.0;
  }

  /// Joints that the sensor does not have lie where the joints around them say: of a body that is
  /// seen, their bones are measured, however indirectly.
  static JointWeights TrustOfBones(const PreparedPosture& prepared, const JointWeights& trust) {
    constexpr double kIndirect = 0.51;
    if (std::count_if(trust.begin(), trust.end(), [](double t) { return t > 0.5; }) < 8) {
      return trust;
    }
    JointWeights out = trust;
    for (size_t i = 0; i < kJointCount; ++i) {
      if (prepared.present[i] == 0.0) out[i] = kIndirect;
    }
    return out;
  }

  /// Whether a joint that this sensor has is in doubt. What it never has (a Kinect's recording
  /// without hands) says nothing of the frame.
  bool InDoubt(const PreparedPosture& prepared, const JointWeights& trust) {
    bool doubt = false;
    for (size_t i = 0; i < kJointCount; ++i) {
      had_[i] = had_[i] || prepared.present[i] > 0.0;
      doubt = doubt || (had_[i] && trust[i] <= kSound);
    }
    return doubt;
  }

  /// Joints in doubt hang on their parents, joints seen well stay. What a doubtful joint hangs like
  /// is a matter of the sensor's own confidence in its guess: of fair guesses the mean, which
  /// hanging as a frame before amounts to, is nearer the truth than any database; of
  /// poor ones the natural posture is.
  void Complete(const PreparedPosture& prepared, const ReconstructionInput& input,
                const JointWeights& trusted, Posture& target) {
    JointWeights trust = trusted;
    for (size_t i = 0; i < kJointCount; ++i) {
      if (FilterKnows(prepared, i)) trust[i] = 1.0;
    }
    if (!InDoubt(prepared, trust)) {
      if (expected_) expected_->Forget();
      return;
    }
    const Posture before = person_.last_in_camera().value_or(prepared.in_camera);
    const bool natural = KnowsNatural(prepared);
    const Posture model = natural ? Natural(prepared, input, trusted) : before;
    JointWeights held;  // 1: where it is seen, 0: where it hangs
    Posture hung;
    for (size_t i = 0; i < kJointCount; ++i) {
      held[i] = OnLine(prepared, i) ? trust[i] / kBetween : std::min(1.0, trust[i] / kSound);
      const double fair = natural ? FairGuess(input, i) : 1.0;
      hung.position_m[i] =
          fair * Hung(before, i, target, prepared) +
          (1.0 - fair) * (i == 0 ? model.position_m[i] : Hung(model, i, target, prepared));
      target.position_m[i] = held[i] * target.position_m[i] + (1.0 - held[i]) * hung.position_m[i];
    }
    ReachOut(held, hung, target);
  }

  /// Whether the learned filter is to have a joint as it is seen, doubted or not: it has learned of
  /// this sensor what to make of gross errors. Of jumps that are waited out it has not.
  bool FilterKnows(const PreparedPosture& prepared, size_t joint) const {
    return options_.filter && filter_.HeardPulls(joint) && prepared.present[joint] > 0.0 &&
           plausibility_.joint_trust()[joint] > kSound;
  }

  /// Whether enough is seen to look for a natural posture like it; else the last one is held.
  bool KnowsNatural(const PreparedPosture& prepared) const {
    constexpr int kFewest = 4;  // fewer joints tell no posture of a database from another
    const auto seen = std::count(prepared.present.begin(), prepared.present.end(), 1.0);
    return expected_ ? seen > 0 : natural_ && seen >= kFewest;
  }

  Posture Natural(const PreparedPosture& prepared, const ReconstructionInput& input,
                  const JointWeights& trust) {
    if (!expected_) return natural_->Step(input).posture;
    return expected_->Step(prepared, trust, person_.last_in_camera(), person_.size().lengths_m());
  }

  /// A limb reaches for what is seen of it: where a hand is not where the arm would have it, the
  /// hidden joints above follow, each by its share of the way from the shoulder.
  void ReachOut(const JointWeights& held, const Posture& hung, Posture& target) const {
    for (size_t end = 0; end < kJointCount; ++end) {
      if (!InLimb(end) || held[end] == 0.0) continue;
      size_t fixed = ParentOf(end);
      while (InLimb(fixed) && held[fixed] < 1.0) fixed = ParentOf(fixed);
      const double whole_m = AlongBones(hung, end, fixed);
      if (!(whole_m > 1e-3)) continue;
      const Eigen::Vector3d pulled_m = target.position_m[end] - hung.position_m[end];
      for (size_t i = ParentOf(end); i != fixed; i = ParentOf(i)) {
        const double share = AlongBones(hung, i, fixed) / whole_m;
        if (lost_[i]) target.position_m[i] += (1.0 - held[i]) * share * pulled_m;
      }
    }
  }

  Posture Filtered(const Posture& target, const PreparedPosture& prepared,
                   const JointWeights& trust) {
    Heard heard;
    for (size_t i = 0; i < kJointCount; ++i) {
      // A posture that is held has been through this filter and must not lag behind what moves it.
      const bool holds = lost_[i] && !KnowsNatural(prepared);
      heard.weights[i] = holds ? 1.0 : std::max(trust[i], kLeastTrust);
      heard.believed[i] = trust[i] > kSound;
      heard.seen[i] = !lost_[i];
    }
    return filter_.Step(target, prepared.placement.yaw_rad, prepared.dt_s, heard);
  }

  /// From a joint up to one of its ancestors.
  static double AlongBones(const Posture& posture, size_t joint, size_t ancestor) {
    double way_m = 0.0;
    for (; joint != ancestor; joint = ParentOf(joint))
      way_m += (posture.position_m[joint] - posture.position_m[ParentOf(joint)]).norm();
    return way_m;
  }

  /// What the sensor's guesses (inferred joints) are worth: how far they are trusted, and from
  /// which confidence on they are fair ones.
  struct Guesses {
    double trust, fair_confidence;
  };
  /// After a close look, or with a depth image, a guess has been held against the surface
  /// (ReliabilityOptions::use_depth), and what is left of them is near the truth. Without one most
  /// guesses of a joint behind something are where that thing is. Of trusts of 0.01 to 0.3 and
  /// confidences of 0.25 to 1 the best on ten rendered scenes of validation subjects.
  Guesses GuessesOf(const ReconstructionInput& input) const {
    return options_.looked || input.depth != nullptr ? Guesses{0.3, 0.25} : Guesses{0.1, 0.75};
  }

  /// In [0, 1]: 0 for a joint the sensor says nothing of.
  double FairGuess(const ReconstructionInput& input, size_t joint) const {
    if (input.observed.state[joint] == TrackingState::kNotTracked) return 0.0;
    const double confidence = input.observed.confidence[joint];
    if (!std::isfinite(confidence)) return 0.0;
    return std::clamp(confidence / GuessesOf(input).fair_confidence, 0.0, 1.0);
  }

  /// Where the joint is when it hangs on its parent in `target` as it does in `posture`.
  static Eigen::Vector3d Hung(const Posture& posture, size_t joint, const Posture& target,
                              const PreparedPosture& prepared) {
    if (joint == 0) return prepared.in_camera.position_m[0];
    const auto parent = ParentOf(joint);
    return target.position_m[parent] + posture.position_m[joint] - posture.position_m[parent];
  }

  static bool InTrunk(size_t joint) { return joint <= Index(Joint::kShoulderCenter); }

  /// Beyond shoulder or hip.
  static bool InLimb(size_t joint) { return joint > 0 && !InTrunk(ParentOf(joint)); }

  bool corrects() const { return options_.correct && !correction_.empty(); }

  Posture OffsetsAt(const Posture& in_camera, const Moment& moment) const {
    const Posture scaled = Scaled(Normalised(in_camera, moment.placement), 1.0 / moment.scale);
    return correction_.Offsets(scaled);
  }

  /// What of an offset stays from posture to posture is the person's and this sensor's view of the
  /// person; it is known better than what changes with the posture.
  void RememberOffsets(const Posture& in_camera, const Moment& moment, double dt_s) {
    if (!corrects()) return;
    constexpr double kMemory_s = 20.0;
    offsets_s_ = std::min(offsets_s_ + dt_s, kMemory_s);
    const Posture now = OffsetsAt(in_camera, moment);
    for (size_t i = 0; i < kJointCount; ++i) {
      mean_offset_.position_m[i] +=
          dt_s / offsets_s_ * (now.position_m[i] - mean_offset_.position_m[i]);
    }
  }

  Posture Corrected(const Posture& in_camera, const Moment& moment) const {
    if (!corrects()) return in_camera;
    Posture offset = OffsetsAt(in_camera, moment);
    for (size_t i = 0; i < kJointCount; ++i) {
      const Eigen::Vector3d& mean = mean_offset_.position_m[i];
      offset.position_m[i] = mean + constants_.of_posture * (offset.position_m[i] - mean);
    }
    const Placement turn{Eigen::Vector3d::Zero(), moment.placement.yaw_rad};
    offset = Placed(Scaled(offset, moment.scale), turn);
    Posture out = in_camera;
    for (size_t i = 0; i < kJointCount; ++i) out.position_m[i] += offset.position_m[i];
    return out;
  }

  ReconstructedPosture WithBones(const Posture& posture, const Moment& moment) const {
    if (!options_.bones) return {posture, moment.reliability};
    // Sensors and markers see limbs; where inside the trunk its joints lie is a matter of
    // definition. They give way first, but for those of a close look, which knows them best.
    const double trunk = options_.looked ? 1.0 : 0.1;
    // Of a limb the far joints give way: sensors see them worst, and a hand that is off must not
    // pull its elbow along.
    JointWeights firm, weights;
    for (size_t i = 0; i < kJointCount; ++i) {
      firm[i] = InLimb(i) ? constants_.outwards * firm[ParentOf(i)] : 1.0;
      weights[i] = (InTrunk(i) ? trunk : firm[i]) * (0.2 + moment.trust[i]);
    }
    return {WithBoneLengths(posture, size_.lengths_m(), weights), moment.reliability};
  }

  BestOptions options_;
  BestConstants constants_;
  std::optional<PriorCompletion> expected_;  // where there is a prior
  std::unique_ptr<Reconstructor> natural_;   // else plantard-2016, where there is a database
  PoseCorrection correction_;
  Person person_{ReliabilityOptions{.use_speed = true}};
  Plausibility plausibility_;
  BodySize size_;                       // of what comes out: the correction may change bones
  std::optional<BoneLengths> bones_m_;  // where they are known
  PostureFilter filter_;
  Posture mean_offset_;     // of this person, normalised and scaled
  double offsets_s_ = 0.0;  // for how long it was averaged
  std::optional<Moment> last_;
  std::optional<ReconstructedPosture> revised_;
  JointArray<bool> had_{};   // joints that were ever seen
  JointArray<bool> lost_{};  // of those: absent now, see FindLost
};

}  // namespace

std::unique_ptr<Reconstructor> MakeBest(const ReconstructorOptions& options) {
  return std::make_unique<Best>(options);
}

}  // namespace ossa::recon
