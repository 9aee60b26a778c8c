// ossa's own method, the default. Causal; a joint seen well passes nearly unchanged. In order:
//   1. whole-person failures (left and right exchanged, a jump to another body) are undone or
//   waited
//      out; single joints that jump are doubted until they stay (gross failures, snapped hands);
//   2. trust of each joint: reliability without the window of eq. 8, which would punish a joint for
//      six frames; softened where good sensors are imprecise anyway (bone lengths);
//   3. joints in doubt are completed from the natural posture space (Shum 2013 sec. V) around the
//      trusted ones and the prediction (Plantard 2016 eq. 7), solved in closed form;
//   4. a filter a joint weighs by trust; a frame later it says better what it thought
//   (lag_filter_internal.h);
//   5. the learned systematic error of the whole posture is taken off (recon/gp/pose_correction.h);
//   6. the person's constant bone lengths are imposed, moving the joints least.
#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "recon/database/nearest.h"
#include "recon/gp/learned_models.h"
#include "recon/methods/bone_projection_internal.h"
#include "recon/methods/lag_filter_internal.h"
#include "recon/methods/methods_internal.h"
#include "recon/methods/person_internal.h"
#include "recon/methods/plausibility_internal.h"
#include "recon/methods/posture_space_internal.h"

namespace ossa::recon {
namespace {

class Best : public Reconstructor {
 public:
  explicit Best(const ReconstructorOptions& options)
      : options_(options.best), database_(options.database) {
    if (const auto learned = LearnedOf(options)) correction_ = learned->correction;
    size_.Expect(correction_.proportion_);
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
      Complete(prepared, trust, target);  // 3.
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
    plausibility_ = Plausibility();
    size_ = BodySize(true);
    size_.Expect(correction_.proportion_);
    hints_.clear();
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

  // A completed joint still enters its filter, as a weak measurement.
  static constexpr double kLeastTrust = 0.05;

  void StartFilters() { filters_.fill(LagFilter()); }

  JointWeights Trust(const PreparedPosture& prepared, const ReconstructionInput& input,
                     double doubt) const {
    JointWeights trust{};
    const Reliability& r = prepared.terms;
    for (size_t i = 0; i < kJointCount; ++i) {
      // Inferred joints of an SDK are guesses, but guesses near the truth.
      constexpr double kInferred = 0.3;
      const double state = input.observed.state[i] == TrackingState::kTracked ? 1.0 : kInferred;
      // Bones of real sensors are off by up to a third in the course of a move; by half they are
      // wrong. Where the trunk's own joints lie, sensors only define, and each differently.
      const double bones = InTrunk(i) ? 1.0 : std::clamp((r.kinematics[i] - 0.5) / 0.2, 0.0, 1.0);
      trust[i] = prepared.present[i] * state * bones * r.behaviour[i] * r.surface[i] *
                 (options_.repair ? plausibility_.joint_trust()[i] : 1.0) * doubt;
      constexpr double kBetween = 0.6;  // as good as the line between two joints that are seen
      if (prepared.between[i] > 0.0) trust[i] = kBetween * doubt;
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

  /// Posture of the space nearest to the trusted joints, to the prediction elsewhere, and to the
  /// neighbours' spread: least squares in q.
  void Complete(const PreparedPosture& prepared, const JointWeights& trust, Posture& target) {
    if (*std::min_element(trust.begin(), trust.end()) > 0.5) return;
    Posture model = person_.last_in_camera() ? *person_.last_in_camera() : prepared.in_camera;
    if (database_) model = person_.InCamera(FromSpace(prepared, trust), prepared);
    // Doubtful joints hang on their parents as the model says; joints in fair trust stay: the
    // filter weighs them.
    constexpr double kSound = 0.5;
    for (size_t i = 0; i < kJointCount; ++i) {
      const double t = std::min(1.0, trust[i] / kSound);
      if (t >= 1.0 || prepared.between[i] > 0.0) continue;
      Eigen::Vector3d hung = model.position_m[i];
      if (i > 0) {
        const auto parent = static_cast<size_t>(kJointParent[i]);
        hung += target.position_m[parent] - model.position_m[parent];
      } else if (person_.last_in_camera()) {
        hung = prepared.in_camera.position_m[0];
      }
      target.position_m[i] = t * target.position_m[i] + (1.0 - t) * hung;
    }
  }

  Posture FromSpace(const PreparedPosture& prepared, const JointWeights& trust) {
    // Prediction: the last posture made, seen from the person's present place.
    PostureVector predicted = VectorOf(prepared.normalised);
    if (person_.last_in_camera()) {
      predicted = VectorOf(Retargeted(Normalised(*person_.last_in_camera(), prepared.placement),
                                      StandardBoneLengths()));
      const Eigen::Vector3f root = predicted.head<3>();
      for (int i = 0; i < kJointCount; ++i) predicted.segment<3>(3 * i) -= root;
    }
    // One search for both: where a joint is trusted it is compared with what is seen, where not,
    // more weakly, with the prediction (eq. 7's two terms).
    const PostureVector observed = VectorOf(prepared.normalised);
    JointWeights weights;
    PostureVector query;
    for (size_t i = 0; i < kJointCount; ++i) {
      const auto t = static_cast<float>(trust[i]);
      const float c = static_cast<float>(options_.continuity) * (1.0F - t);
      const auto at = static_cast<Eigen::Index>(3 * i);
      weights[i] = t + c;
      query.segment<3>(at) =
          (t * observed.segment<3>(at) + c * predicted.segment<3>(at)) / std::max(t + c, 1e-6F);
    }
    const auto nearest = NearestPostures(*database_, query, weights, options_.neighbours, hints_);
    hints_.clear();
    for (const Neighbour& n : nearest) hints_.push_back(n.index);
    const PostureSpace space = MakePostureSpace(*database_, hints_, options_.dimensions);
    if (space.dimensions() == 0) return PostureOf(space.mean);
    const PostureVector w = CoordinateWeights(weights);
    const PostureVector d = query - space.mean;
    Eigen::MatrixXf a = space.basis.transpose().lazyProduct(w.asDiagonal() * space.basis);
    a.diagonal().array() += static_cast<float>(options_.space_noise_m * options_.space_noise_m) /
                            space.deviation.array().square();
    const Eigen::VectorXf b = space.basis.transpose().lazyProduct(PostureVector(w.cwiseProduct(d)));
    return PostureOf(space.Posture(a.llt().solve(b)));
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
    // 0.5 to 0.7 are as good on people left out (UI-PRMD): the error within a clip is 6 % less than
    // with 1, the whole error the same.
    constexpr double kOfPosture = 0.6;
    Posture offset = OffsetsAt(in_camera, moment);
    for (size_t i = 0; i < kJointCount; ++i) {
      const Eigen::Vector3d& mean = mean_offset_.position_m[i];
      offset.position_m[i] = mean + kOfPosture * (offset.position_m[i] - mean);
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
    JointWeights weights;
    for (size_t i = 0; i < kJointCount; ++i) {
      weights[i] = (InTrunk(i) ? kTrunk : 1.0) * (0.2 + moment.trust[i]);
    }
    return {WithBoneLengths(posture, size_.lengths_m(), weights), moment.reliability};
  }

  BestOptions options_;
  std::shared_ptr<const PostureDatabase> database_;
  PoseCorrection correction_;
  Person person_;
  Plausibility plausibility_;
  BodySize size_{true};  // of what comes out: the correction may change bones
  std::array<LagFilter, kJointCount> filters_;
  Posture mean_offset_;     // of this person, normalised and scaled
  double offsets_s_ = 0.0;  // for how long it was averaged
  std::optional<Moment> last_;
  std::optional<ReconstructedPosture> revised_;
  std::vector<int> hints_;
};

}  // namespace

std::unique_ptr<Reconstructor> MakeBest(const ReconstructorOptions& options) {
  return std::make_unique<Best>(options);
}

}  // namespace ossa::recon
