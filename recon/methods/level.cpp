#include <algorithm>
#include <cmath>
#include <utility>

#include "depth/base/angles.h"
#include "recon/methods/level_internal.h"
#include "recon/placed_joint.h"
#include "recon/smallest_turn.h"

namespace ossa::recon {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

bool IsSeen(const TrackedPosture& observed, Joint joint) {
  return observed.state[Index(joint)] == TrackingState::kTracked &&
         IsPossiblePlace(observed.posture[joint]);
}

Vector3d MiddleOf(const Posture& posture, Joint left, Joint right) {
  return 0.5 * (posture[left] + posture[right]);
}

// Constants: shares of the body's mass, no unit; P. de Leva, "Adjustments to Zatsiorsky-Seluyanov's
// segment inertia parameters", J. Biomechanics 29(9), 1996, table 4, mean of men and women.

/// None unless legs and trunk are seen and both feet carry weight. An arm's mass is placed at its
/// elbow.
std::optional<Stance> FindStance(const TrackedPosture& observed, const LevelOptions& options) {
  constexpr double kHead = 0.068, kTrunk = 0.430, kArms = 0.094, kThighs = 0.290, kShanks = 0.092,
                   kFeet = 0.026;
  const Posture& p = observed.posture;
  for (const Joint joint :
       {Joint::kShoulderCenter, Joint::kHipLeft, Joint::kKneeLeft, Joint::kAnkleLeft,
        Joint::kHipRight, Joint::kKneeRight, Joint::kAnkleRight}) {
    if (!IsSeen(observed, joint)) return std::nullopt;
  }
  const auto both_seen = [&](Joint left, Joint right) {
    return IsSeen(observed, left) && IsSeen(observed, right);
  };
  const Vector3d hips = MiddleOf(p, Joint::kHipLeft, Joint::kHipRight);
  const Vector3d knees = MiddleOf(p, Joint::kKneeLeft, Joint::kKneeRight);
  const Vector3d ankles = MiddleOf(p, Joint::kAnkleLeft, Joint::kAnkleRight);
  const Vector3d chest = 0.5 * (p[Joint::kShoulderCenter] + hips);
  const Vector3d feet = both_seen(Joint::kFootLeft, Joint::kFootRight)
                            ? 0.5 * (ankles + MiddleOf(p, Joint::kFootLeft, Joint::kFootRight))
                            : ankles;
  const Vector3d arms = both_seen(Joint::kElbowLeft, Joint::kElbowRight)
                            ? MiddleOf(p, Joint::kElbowLeft, Joint::kElbowRight)
                            : chest;
  const Vector3d head =
      IsSeen(observed, Joint::kHead) ? p[Joint::kHead] : p[Joint::kShoulderCenter];
  const Vector3d mass = kHead * head + kTrunk * chest + kArms * arms +
                        0.5 * kThighs * (hips + knees) + 0.5 * kShanks * (knees + ankles) +
                        kFeet * feet;
  const Vector3d balance = mass - feet, apart = p[Joint::kAnkleLeft] - p[Joint::kAnkleRight];
  const double raised_m = apart.dot(balance.normalized());
  const bool both_carry =
      std::abs(raised_m) <= options.most_raised_m &&
      apart.squaredNorm() - raised_m * raised_m <= options.most_apart_m * options.most_apart_m;
  if (!both_carry) return std::nullopt;
  return Stance{balance, p[Joint::kShoulderCenter] - hips, hips - knees, knees - ankles};
}

void DropImpossibleJoints(TrackedPosture& observed) {
  for (size_t i = 0; i < kJointCount; ++i) {
    if (!IsPossiblePlace(observed.posture.position_m[i])) {
      observed.state[i] = TrackingState::kNotTracked;
    }
  }
}

class Levelled : public Reconstructor {
 public:
  explicit Levelled(std::unique_ptr<Reconstructor> method) : method_(std::move(method)) {}

  ReconstructedPosture Step(const ReconstructionInput& input) override {
    const std::optional<Isometry3d> before = level_from_camera_;
    ReconstructionInput levelled = input;
    DropImpossibleJoints(levelled.observed);
    level_from_camera_ = level_.Update(levelled.observed, input.floor);
    const bool is_new = level_from_camera_.has_value() != before.has_value() ||
                        (before && !before->isApprox(*level_from_camera_));
    if (is_new && started_) cut_s_ += kCut_s;
    started_ = true;
    levelled.time_s += cut_s_;
    if (level_from_camera_) {
      levelled.observed.posture = Moved(input.observed.posture, *level_from_camera_);
      levelled.camera_from_observed = level_from_camera_->inverse();
    }
    ReconstructedPosture made = InCamera(method_->Step(levelled));
    revised_ = method_->Revised();
    if (revised_) revised_ = InCamera(*revised_);  // empty after a cut, so of the same level
    return made;
  }

  std::optional<ReconstructedPosture> Revised() const override { return revised_; }
  std::optional<BoneLengths> Bones() const override { return method_->Bones(); }

  void Reset() override {
    method_->Reset();
    level_.Reset();
    level_from_camera_.reset();
    revised_.reset();
    cut_s_ = 0.0;
    started_ = false;
  }

 private:
  static constexpr double kCut_s = 10.0;  // by hand: longer than the gaps that methods bridge

  ReconstructedPosture InCamera(ReconstructedPosture made) const {
    if (!level_from_camera_) return made;
    const Isometry3d camera_from_level = level_from_camera_->inverse();
    made.posture = Moved(made.posture, camera_from_level);
    if (made.orientation) {
      const Eigen::Quaterniond turn(camera_from_level.linear());
      for (Eigen::Quaterniond& q : *made.orientation) q = (turn * q).normalized();
    }
    return made;
  }

  std::unique_ptr<Reconstructor> method_;
  LevelEstimator level_;
  std::optional<Isometry3d> level_from_camera_;
  std::optional<ReconstructedPosture> revised_;
  double cut_s_ = 0.0;  // offset of reported times, from the cuts
  bool started_ = false;
};

}  // namespace

Posture Moved(const Posture& posture, const Isometry3d& to_from) {
  Posture out;
  for (size_t i = 0; i < kJointCount; ++i) out.position_m[i] = to_from * posture.position_m[i];
  return out;
}

const std::optional<Isometry3d>& LevelEstimator::Update(
    const TrackedPosture& observed, const std::optional<Eigen::Vector4d>& floor) {
  if (floor && floor->head<3>().norm() > 0.0) {
    const Vector3d up = floor->head<3>().normalized();
    if (Confirm(up)) Level(up, options_.floor_least_deg, observed.posture);
    return level_from_camera_;
  }
  floor_frames_ = 0;
  if (floor_confirmed_) return level_from_camera_;  // less accurate from a body
  Observe(observed);
  if (standing_frames_ > 0)
    Level(standing_up_.normalized(), options_.body_least_deg, observed.posture);
  return level_from_camera_;
}

bool LevelEstimator::Confirm(const Vector3d& up) {
  const bool alike = ToDegrees(AngleBetween_rad(up, floor_up_)) <= options_.change_deg;
  floor_frames_ = alike ? std::min(floor_frames_ + 1, options_.floor_frames) : 1;
  floor_up_ = up;
  if (floor_frames_ < options_.floor_frames) return false;
  floor_confirmed_ = true;
  return true;
}

std::optional<Vector3d> LevelEstimator::StandingUp() const {
  if (stances_.size() < static_cast<size_t>(options_.fewest_frames)) return std::nullopt;
  Stance sum = {Vector3d::Zero(), Vector3d::Zero(), Vector3d::Zero(), Vector3d::Zero()};
  for (const Stance& stance : stances_) {
    sum.balance_m += stance.balance_m;
    sum.trunk_m += stance.trunk_m;
    sum.thighs_m += stance.thighs_m;
    sum.shanks_m += stance.shanks_m;
  }
  for (const Vector3d& part : {sum.trunk_m, sum.thighs_m, sum.shanks_m}) {
    if (!(ToDegrees(AngleBetween_rad(part, sum.balance_m)) <= options_.most_bent_deg))
      return std::nullopt;
  }
  return sum.balance_m.normalized();
}

void LevelEstimator::Observe(const TrackedPosture& observed) {
  const auto stance = FindStance(observed, options_);
  if (!stance) return;
  stances_.push_back(*stance);
  if (stances_.size() > static_cast<size_t>(options_.fewest_frames)) stances_.pop_front();
  const auto up = StandingUp();
  if (!up || ToDegrees(AngleBetween_rad(*up, Vector3d::UnitY())) > options_.most_deg) return;
  standing_frames_ = std::min(standing_frames_ + 1, options_.memory_frames);
  standing_up_ += (*up - standing_up_) / standing_frames_;
}

void LevelEstimator::Level(const Vector3d& up, double least_deg, const Posture& observed) {
  const double tilt_deg = ToDegrees(AngleBetween_rad(up, Vector3d::UnitY()));
  if (!(tilt_deg <= options_.most_deg)) return;
  if (ToDegrees(AngleBetween_rad(up, up_)) <=
      (level_from_camera_ ? options_.change_deg : least_deg))
    return;
  up_ = up;
  if (tilt_deg <= least_deg) {
    level_from_camera_.reset();
    up_ = Vector3d::UnitY();
    return;
  }
  // Rotate about the person, who then stays at a distance that the methods expect.
  const Vector3d& root = observed.position_m[0];
  const Vector3d pivot = IsPossiblePlace(root) ? root : Vector3d::Zero();
  level_from_camera_ = Eigen::Translation3d(pivot) *
                       Isometry3d(SmallestTurn(up, Vector3d(Vector3d::UnitY()))) *
                       Eigen::Translation3d(-pivot);
}

std::unique_ptr<Reconstructor> MakeLevelled(std::unique_ptr<Reconstructor> method) {
  return std::make_unique<Levelled>(std::move(method));
}

}  // namespace ossa::recon
