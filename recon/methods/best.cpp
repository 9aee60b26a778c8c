// ossa's own method, the default. Causal; a joint seen well passes nearly unchanged. In order:
//   1. whole-person failures (left and right exchanged, a jump to another body) are undone or
//   waited
//      out; single joints that jump are doubted until they stay (gross failures, snapped hands);
//   2. trust of each joint: reliability without the window of eq. 8, which would punish a joint for
//      six frames; softened where good sensors are imprecise anyway (bone lengths);
//   3. joints in doubt are completed from the natural posture space (Shum 2013 sec. V) around the
//      trusted ones and the prediction (Plantard 2016 eq. 7), solved in closed form;
//   4. the learned systematic error of the whole posture is taken off (recon/gp/pose_correction.h);
//   5. a Kalman filter a joint, its process noise adapted to the motion, weighs by trust;
//   6. the person's constant bone lengths are imposed.
#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "recon/database/nearest.h"
#include "recon/gp/learned_models.h"
#include "recon/methods/adaptive_kalman_internal.h"
#include "recon/methods/bone_projection_internal.h"
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
    ResetFilters();
  }

  ReconstructedPosture Step(const ReconstructionInput& raw) override {
    ReconstructionInput input = raw;
    const double doubt = options_.repair ? plausibility_.Repair(input) : 1.0;  // 1.
    const PreparedPosture prepared = person_.Prepare(input);
    if (prepared.restarted) ResetFilters();
    JointWeights trust = Trust(prepared, input, doubt);  // 2.
    Posture target = prepared.in_camera;
    if (options_.complete) Complete(prepared, trust, target);                 // 3.
    if (options_.correct && !correction_.empty()) Correct(prepared, target);  // 4.
    Posture made = target;
    if (options_.filter) {
      for (size_t i = 0; i < kJointCount; ++i) {  // 5.
        made.position_m[i] =
            filters_[i].Step(target.position_m[i], prepared.dt_s, std::max(trust[i], kLeastTrust));
      }
    }
    size_.Observe(made, trust, prepared.scale);
    if (options_.bones) made = WithBoneLengths(made, size_.lengths_m(), trust);  // 6.
    ReconstructedPosture out{made, prepared.reliability};
    for (size_t i = 0; i < kJointCount; ++i) {
      out.reliability[i] = std::min(out.reliability[i], trust[i]);
    }
    plausibility_.Remember(made, prepared.dt_s);
    person_.Remember(made, prepared);
    return out;
  }

  void Reset() override {
    person_.Reset();
    plausibility_ = Plausibility();
    size_ = BodySize();
    size_.Expect(correction_.proportion_);
    hints_.clear();
    ResetFilters();
  }

 private:
  // A completed joint still enters its filter, as a weak measurement.
  static constexpr double kLeastTrust = 0.05;

  void ResetFilters() {
    filters_.fill(AdaptiveKalman());
    offset_started_ = false;
  }

  JointWeights Trust(const PreparedPosture& prepared, const ReconstructionInput& input,
                     double doubt) const {
    JointWeights trust{};
    const Reliability& r = prepared.terms;
    for (size_t i = 0; i < kJointCount; ++i) {
      // Inferred joints of an SDK are guesses, but guesses near the truth.
      constexpr double kInferred = 0.3;
      const double state = input.observed.state[i] == TrackingState::kTracked ? 1.0 : kInferred;
      // Bones of real sensors are off by up to a third in the course of a move; by half they are
      // wrong.
      const double bones = std::clamp((r.kinematics[i] - 0.5) / 0.2, 0.0, 1.0);
      trust[i] = prepared.present[i] * state * bones * r.behaviour[i] * r.surface[i] *
                 (options_.repair ? plausibility_.joint_trust()[i] : 1.0) * doubt;
    }
    return trust;
  }

  /// Posture of the space nearest to the trusted joints, to the prediction elsewhere, and to the
  /// neighbours' spread: least squares in q.
  void Complete(const PreparedPosture& prepared, const JointWeights& trust, Posture& target) {
    if (*std::min_element(trust.begin(), trust.end()) > 0.9) return;
    Posture model = person_.last_in_camera() ? *person_.last_in_camera() : prepared.in_camera;
    if (database_) model = person_.InCamera(FromSpace(prepared, trust), prepared);
    // Doubtful joints hang on their parents as the model says; joints in full trust stay.
    for (size_t i = 0; i < kJointCount; ++i) {
      const double t = std::min(1.0, trust[i] / 0.9);
      if (t >= 1.0) continue;
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

  /// The offsets change slowly: a low pass keeps the noise of the feature out of the posture.
  void Correct(const PreparedPosture& prepared, Posture& target) {
    constexpr double kTimeConstant_s = 0.1;
    const Posture now = correction_.Offsets(prepared.scaled);
    const double gain = offset_started_ ? 1.0 - std::exp(-prepared.dt_s / kTimeConstant_s) : 1.0;
    offset_started_ = true;
    Placement turn{Eigen::Vector3d::Zero(), prepared.placement.yaw_rad};
    for (size_t i = 0; i < kJointCount; ++i) {
      offset_.position_m[i] += gain * (now.position_m[i] - offset_.position_m[i]);
    }
    const Posture turned = Placed(Scaled(offset_, prepared.scale), turn);
    for (size_t i = 0; i < kJointCount; ++i) target.position_m[i] += turned.position_m[i];
  }

  BestOptions options_;
  std::shared_ptr<const PostureDatabase> database_;
  PoseCorrection correction_;
  Person person_;
  Plausibility plausibility_;
  BodySize size_;  // of what comes out: the correction may change bones
  std::array<AdaptiveKalman, kJointCount> filters_;
  Posture offset_;
  bool offset_started_ = false;
  std::vector<int> hints_;
};

}  // namespace

std::unique_ptr<Reconstructor> MakeBest(const ReconstructorOptions& options) {
  return std::make_unique<Best>(options);
}

}  // namespace ossa::recon
