// ossa's own method, the default. Causal; a joint seen well passes nearly unchanged. In order:
//   1. whole-person failures (left and right exchanged, a jump to another body) are undone or
//      waited out; single joints that jump are doubted until they stay (gross failures, snapped
//      hands);
//   2. trust of each joint: reliability without the window of eq. 8, which would punish a joint for
//      six frames; softened where good sensors are imprecise anyway (bone lengths);
//   3. joints in doubt are completed: hung on what is seen, as they hung before where the sensor's
//      guesses are fair, else as plantard-2016 has them in a natural posture;
//   4. a filter a joint weighs by trust; a frame later it says better what it thought
//      (lag_filter_internal.h);
//   5. the learned systematic error of the whole posture is taken off (recon/gp/pose_correction.h);
//   6. the person's constant bone lengths are imposed, moving the joints least.
#include <algorithm>
#include <cmath>

#include "recon/gp/learned_models.h"
#include "recon/methods/bone_projection_internal.h"
#include "recon/methods/lag_filter_internal.h"
#include "recon/methods/methods_internal.h"
#include "recon/methods/person_internal.h"
#include "recon/methods/plausibility_internal.h"

namespace ossa::recon {
namespace {

class Best : public Reconstructor {
 public:
  explicit Best(const ReconstructorOptions& options)
      : options_(options.best),
        constants_(options.best.constants),
        plausibility_(constants_.slack_m) {
    if (const auto learned = LearnedOf(options)) correction_ = learned->correction;
    size_.Expect(correction_.proportions, constants_.expected);
    StartFilters();
    if (options.database) natural_ = MakePlantard2016(ForCompletion(options));
  }

  ReconstructedPosture Step(const ReconstructionInput& raw) override {
    ReconstructionInput input = raw;
    const double doubt = options_.repair ? plausibility_.Repair(input) : 1.0;  // 1.
    const PreparedPosture prepared = person_.Prepare(input);
    if (prepared.restarted) StartFilters();
    JointWeights trust = Trust(prepared, input, doubt);  // 2.
    Posture target = prepared.in_camera;
    if (doubt == 0.0 && person_.last_in_camera()) {
      target = *person_.last_in_camera();  // somebody else, perhaps: the person stays
    } else if (options_.complete) {
      Complete(prepared, input, trust, target);  // 3.
    }
    if (plausibility_.elsewhere()) StartFilters();
    Posture now = target, before = target;
    for (size_t i = 0; options_.filter && i < kJointCount; ++i) {  // 4.
      const double heard = std::max(trust[i], kLeastTrust);
      now.position_m[i] = filters_[i].Step(target.position_m[i], prepared.dt_s, heard);
      before.position_m[i] = filters_[i].before_m();
    }
    Moment moment{doubt > 0.0 ? now : prepared.in_camera, prepared.placement, prepared.scale, trust,
                  prepared.reliability};
    for (size_t i = 0; i < kJointCount; ++i) {
      moment.reliability[i] = std::min(moment.reliability[i], trust[i]);
    }
    RememberOffsets(now, moment, prepared.dt_s);
    const Posture corrected = Corrected(now, moment);  // 5.
    size_.Observe(corrected, TrustOfBones(prepared, trust), prepared.scale);
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

  void Reset() override {
    person_.Reset();
    plausibility_ = Plausibility(constants_.slack_m);
    size_ = BodySize(true);
    size_.Expect(correction_.proportions, constants_.expected);
    if (natural_) natural_->Reset();
    had_.fill(false);
    mean_offset_ = Posture();
    offsets_s_ = 0.0;
    last_.reset();
    revised_.reset();
    StartFilters();
  }

 private:
  /// What a frame's last steps need to know of it.
  struct Moment {
    Posture stands;  // should the next frame tell nothing of it: what was seen, if it was a jump
    Placement placement;
    double scale = 1.0;
    JointWeights trust{}, reliability{};
  };

  // A completed joint enters its filter as a measurement of twice the variance: the natural posture
  // follows the joints that are seen.
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
    return options;
  }

  void StartFilters() { filters_.fill(LagFilter(constants_)); }

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
      trust[i] = prepared.present[i] * state * bones * r.behaviour[i] * r.surface[i] *
                 (options_.repair ? plausibility_.joint_trust()[i] : 1.0) * doubt;
    }
    for (const BetweenTwo& line : kBetweenTwo) {
      const auto at = [](Joint joint) { return static_cast<size_t>(Index(joint)); };
      if (prepared.between[at(line.joint)] == 0.0) continue;
      const double ends = std::min({trust[at(line.a)], trust[at(line.b)], 1.0});
      trust[at(line.joint)] = kBetween * ends;
    }
    return trust;
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
                const JointWeights& trust, Posture& target) {
    if (!InDoubt(prepared, trust)) return;
    const Posture before =
        person_.last_in_camera() ? *person_.last_in_camera() : prepared.in_camera;
    constexpr int kFewest = 4;  // fewer joints tell no posture from another
    const auto seen = std::count(prepared.present.begin(), prepared.present.end(), 1.0);
    const bool natural = natural_ && seen >= kFewest;
    const Posture model = natural ? natural_->Step(input).posture : before;
    for (size_t i = 0; i < kJointCount; ++i) {
      const double held =
          prepared.between[i] > 0.0 ? trust[i] / kBetween : std::min(1.0, trust[i] / kSound);
      const double fair = natural ? FairGuess(input, i) : 1.0;
      const Eigen::Vector3d hung =
          fair * Hung(before, i, target, prepared) +
          (1.0 - fair) * (i == 0 ? model.position_m[i] : Hung(model, i, target, prepared));
      target.position_m[i] = held * target.position_m[i] + (1.0 - held) * hung;
    }
  }

  /// What the sensor's guesses (inferred joints) are worth: how far they are trusted, and from
  /// which confidence on they are fair ones.
  struct Guesses {
    double trust, fair_confidence;
  };
  /// With a depth image a guess has been held against the surface (ReliabilityOptions::use_depth),
  /// and what is left of them is near the truth. Without one most guesses of a joint behind
  /// something are where that thing is. Of trusts of 0.01 to 0.3 and confidences of 0.25 to 1 the
  /// best on ten rendered scenes of validation subjects.
  static Guesses GuessesOf(const ReconstructionInput& input) {
    return input.depth != nullptr ? Guesses{0.3, 0.25} : Guesses{0.1, 0.75};
  }

  /// In [0, 1]: 0 for a joint the sensor says nothing of.
  static double FairGuess(const ReconstructionInput& input, size_t joint) {
    if (input.observed.state[joint] == TrackingState::kNotTracked) return 0.0;
    return std::clamp(input.observed.confidence[joint] / GuessesOf(input).fair_confidence, 0.0,
                      1.0);
  }

  /// Where the joint is when it hangs on its parent in `target` as it does in `posture`.
  static Eigen::Vector3d Hung(const Posture& posture, size_t joint, const Posture& target,
                              const PreparedPosture& prepared) {
    if (joint == 0) return prepared.in_camera.position_m[0];
    const auto parent = static_cast<size_t>(kJointParent[joint]);
    return target.position_m[parent] + posture.position_m[joint] - posture.position_m[parent];
  }

  static bool InTrunk(size_t joint) {
    return joint <= static_cast<size_t>(Index(Joint::kShoulderCenter));
  }

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
    // definition. They give way first.
    constexpr double kTrunk = 0.1;
    // Of a limb the far joints give way: sensors see them worst, and a hand that is off must not
    // pull its elbow along.
    JointWeights firm, weights;
    for (size_t i = 0; i < kJointCount; ++i) {
      const bool in_limb = i > 0 && !InTrunk(static_cast<size_t>(kJointParent[i]));
      firm[i] = in_limb ? constants_.outwards * firm[static_cast<size_t>(kJointParent[i])] : 1.0;
      weights[i] = (InTrunk(i) ? kTrunk : firm[i]) * (0.2 + moment.trust[i]);
    }
    return {WithBoneLengths(posture, size_.lengths_m(), weights), moment.reliability};
  }

  BestOptions options_;
  BestConstants constants_;
  std::unique_ptr<Reconstructor> natural_;  // plantard-2016, where there is a database
  PoseCorrection correction_;
  Person person_;
  Plausibility plausibility_;
  BodySize size_{true};  // of what comes out: the correction may change bones
  std::array<LagFilter, kJointCount> filters_;
  Posture mean_offset_;     // of this person, normalised and scaled
  double offsets_s_ = 0.0;  // for how long it was averaged
  std::optional<Moment> last_;
  std::optional<ReconstructedPosture> revised_;
  std::array<bool, kJointCount> had_{};  // joints that were ever seen
};

}  // namespace

std::unique_ptr<Reconstructor> MakeBest(const ReconstructorOptions& options) {
  return std::make_unique<Best>(options);
}

}  // namespace ossa::recon
