#include "tools/tracker/mechanics.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "recon/normalise.h"
#include "tools/tracker/mechanics_internal.h"

namespace ossa::tracker {
namespace {

using recon::kJointCount;

/// Bone lengths of a posture; implausible ones are replaced by standard ones at the scale of the
/// others.
recon::BoneLengths MeasureSaneBones(const recon::Posture& posture) {
  recon::BoneLengths lengths_m = recon::MeasureBoneLengths(posture);
  recon::JointWeights sane{};
  for (size_t i = 1; i < kJointCount; ++i) {
    sane[i] = lengths_m[i] > 0.01 && lengths_m[i] < 2.0 ? 1.0 : 0.0;
    if (sane[i] == 0.0) lengths_m[i] = recon::StandardBoneLengths()[i];
  }
  sane[0] = 1.0;
  const double scale = recon::EstimateBodyScale(lengths_m, sane);
  for (size_t i = 1; i < kJointCount; ++i) {
    if (sane[i] == 0.0) lengths_m[i] *= scale;
  }
  return lengths_m;
}

// Constants: chosen by hand on rendered indoor scenes.

// Least weight of an unseen joint, which the reconstruction placed. Without it an unseen foot hangs
// off the ankle, 14 cm wrong instead of 5 (rendered rooms).
constexpr double kCompleted = 0.5;

// Depth of a joint below the floor from which the floor is rejected, and up to which it is accepted
// again. A sensor that sees no floor may detect a table top as floor, and legs occluded by the
// table would be lifted onto it (rendered rooms: feet 23 cm wrong instead of 16). People standing
// on a floor are never this far below it.
constexpr double kImpossible_m = 0.2, kPossible_m = 0.1;

bool AllFinite(const recon::Posture& posture) {
  return std::all_of(posture.position_m.begin(), posture.position_m.end(),
                     [](const Eigen::Vector3d& p) { return p.allFinite(); });
}

/// Orientations, if all bones have one.
std::optional<recon::JointOrientations> FindOrientations(const recon::BodyRecord& body) {
  recon::JointOrientations orientations;
  for (size_t i = 0; i < kJointCount; ++i) {
    if (!body.joints[i] || !body.joints[i]->orientation) return std::nullopt;
    orientations[i] = *body.joints[i]->orientation;
  }
  return orientations;
}

void FollowBody(const recon::SkeletonFrame& frame, Mechanics& mechanics, recon::BodyRecord& body) {
  recon::Posture target;
  recon::JointWeights trust{};
  for (size_t i = 0; i < kJointCount; ++i) {
    const auto& joint = body.joints[i];
    target.position_m[i] =
        joint ? joint->position_m
              : Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN());
    trust[i] = joint ? joint->reliability.value_or(1.0) : 0.0;
  }
  const auto made =
      mechanics.Follow(target, trust, frame.floor, frame.time_s, FindOrientations(body));
  if (made) SetJoints(made->posture, made->orientation, body);
}

}  // namespace

void SetJoints(const recon::Posture& posture, const recon::JointOrientations& orientation,
               recon::BodyRecord& body) {
  for (size_t i = 0; i < kJointCount; ++i) {
    auto& joint = body.joints[i];
    if (!joint) {
      joint.emplace();
      joint->state = recon::TrackingState::kInferred;
      joint->reliability = 0.0;
    }
    joint->position_m = posture.position_m[i];
    joint->orientation = orientation[i];
  }
}

std::optional<Eigen::Vector4d> Mechanics::OwnFloor(const recon::Posture& target,
                                                   const std::optional<Eigen::Vector4d>& floor) {
  if (!floor) return std::nullopt;
  double deepest_m = 0.0;
  for (const Eigen::Vector3d& p : target.position_m) {
    if (p.allFinite()) deepest_m = std::max(deepest_m, -floor->dot(p.homogeneous()));
  }
  floor_is_another_ = deepest_m > (floor_is_another_ ? kPossible_m : kImpossible_m);
  return floor_is_another_ ? std::nullopt : floor;
}

void Mechanics::Make() {
  physics::CharacterFilterOptions options;
  if (build_.motors) options.control = physics::Control::kMotor;
  options.hinges = build_.hinges;
  options.joint_limits = build_.joint_limits;
  options.gains.rate_rad_s = rate_rad_s_;
  character_ = std::make_unique<physics::CharacterFilter>(bones_.lengths_m(), options);
}

bool CharacterBones::Update(const recon::Posture& seen) {
  constexpr double kSame = 0.001, kOther = 0.01;  // share of the length
  constexpr int kPatience_frames = 10;
  const recon::BoneLengths bones_m = MeasureSaneBones(seen);
  if (!(bones_m_[1] > 0.0)) {
    bones_m_ = bones_m;
    return true;
  }
  const auto most = [&](const recon::BoneLengths& other_m) {
    double share = 0.0;
    for (size_t i = 1; i < kJointCount; ++i) {
      share = std::max(share, std::abs(bones_m[i] / other_m[i] - 1.0));
    }
    return share;
  };
  same_frames_ = latest_m_[1] > 0.0 && most(latest_m_) < kSame ? same_frames_ + 1 : 0;
  latest_m_ = bones_m;
  const bool is_anew = same_frames_ == kPatience_frames && most(bones_m_) > kOther;
  if (is_anew) bones_m_ = bones_m;
  return is_anew;
}

double HeldTrust(double trust) { return std::max(trust, kCompleted); }

std::optional<physics::FilteredPosture> Mechanics::Follow(
    const recon::Posture& target, std::span<const double> trust,
    const std::optional<Eigen::Vector4d>& floor, double time_s,
    const std::optional<recon::JointOrientations>& orientation) {
  if (bones_.Update(target)) Make();
  const double step_s = steps_.To(time_s).value_or(0.0);
  std::vector<double> held(trust.begin(), trust.end());
  for (size_t i = 0; i < held.size(); ++i) {
    if (target.position_m[i].allFinite()) held[i] = HeldTrust(held[i]);
  }
  const auto filtered =
      character_->Step(target, held, OwnFloor(target, floor), step_s, orientation);
  if (!AllFinite(filtered.posture)) return std::nullopt;
  return filtered;
}

void FollowMechanically(recon::SkeletonSequence& sequence, const MechanicsBuild& build,
                        const std::function<bool(size_t)>& progress) {
  std::map<int, Mechanics> people;
  size_t done = 0;
  for (recon::SkeletonFrame& frame : sequence.frames) {
    for (recon::BodyRecord& body : frame.bodies) {
      const auto person = people.try_emplace(body.id, build).first;
      FollowBody(frame, person->second, body);
    }
    if (progress && !progress(++done)) return;
  }
}

}  // namespace ossa::tracker
