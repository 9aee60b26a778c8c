#include <algorithm>
#include <cmath>

#include "depth/base/error.h"
#include "physics/actor_internal.h"
#include "physics/fit_bone_lengths.h"
#include "recon/orientation.h"

namespace ossa::physics {
namespace {

using Eigen::Vector3d;
using Eigen::Vector4d;
using recon::kJointCount;
using recon::Posture;

recon::BoneLengths Checked(recon::BoneLengths lengths) {
  for (size_t i = 1; i < kJointCount; ++i) {
    if (!(lengths[i] > 0.0 && lengths[i] <= 2.0)) {
      throw InputError("character: length of the bone to " + std::string(recon::kJointNames[i]) +
                       " is " + std::to_string(lengths[i]) + ", must be in (0, 2] m");
    }
    lengths[i] = std::max(lengths[i], 0.01);
  }
  return lengths;
}

/// A joint of trust 0 still follows, slowly: its position was completed by an earlier stage.
constexpr double kLeastStiffness = 0.3;  // share
// Constants: chosen by hand unless stated otherwise; thresholds of Lead by a sweep on UI-PRMD
// and noisy motion capture.

/// A user constraint pulls the other joints of its chain (sec. 6.1), not vice versa.
constexpr double kConstrainedWeight = 50.0;  // times the weight of other joints
constexpr double kFarthest_m = 1000.0;       // targets beyond are invalid
constexpr double kLargestSpeed_m_s = 15.0;   // largest speed of a target; a fast punch has 10

double SmoothStep(double x, double from, double to) {
  const double t = std::clamp((x - from) / (to - from), 0.0, 1.0);
  return t * t * (3.0 - 2.0 * t);
}

/// Raises target joints below the floor onto it. Returns whether anything moved.
bool LiftOntoFloor(const std::optional<Vector4d>& floor, double height_m, Posture& posture) {
  bool lifted = false;
  if (!floor) return false;
  for (auto& p : posture.position_m) {
    const double below = height_m - HeightAbove(*floor, p);
    if (below <= 0.0) continue;
    p += below * floor->head<3>();
    lifted = true;
  }
  return lifted;
}

}  // namespace

Actor::Actor(OdeWorld& ode, const recon::BoneLengths& bone_lengths,
             const CharacterOptions& character_options, int tag)
    : lengths(Checked(bone_lengths)),
      options(character_options),
      made(ode.made++),
      character(ode, ComputeSegments(lengths, options.stature_m, options.mass_kg),
                {options.control, options.hinges, tag}) {
  if (options.joint_limits) limits = std::make_unique<JointLimits>(ode, character);
  Forget();
}

void Actor::Forget() {
  weight.fill(1.0);
  aim_velocity_m_s.fill(Vector3d::Zero());
  control.angular_velocity_rad_s.fill(Vector3d::Zero());
  mean_velocity_m_s.fill(Vector3d::Zero());
  mean_speed_m_s.fill(0.0);
}

double Actor::SoleHeight() const {
  return character.segments()[recon::Index(recon::Joint::kFootLeft)].radius_m;
}

void Actor::Place(const Posture& posture, const std::optional<Vector4d>& floor) {
  recon::JointArray<double> even;
  even.fill(1.0);
  aim = FitBoneLengths(posture, lengths, even);
  if (floor) {
    // Raises the whole posture until nothing is below the floor.
    double below = 0.0;
    for (const auto& p : aim.position_m) {
      below = std::max(below, SoleHeight() - HeightAbove(*floor, p));
    }
    for (auto& p : aim.position_m) p += below * floor->head<3>();
  }
  wanted = last_aim = aim;
  aim_velocity_m_s.fill(Vector3d::Zero());
  mean_velocity_m_s.fill(Vector3d::Zero());
  mean_speed_m_s.fill(0.0);
  character.Place(aim, OrientAim());
  for (FootPin& pin : foot_pin) pin.Clear();
  pushes.clear();
  pulls.clear();
}

void Actor::SetTarget(const Posture& target, std::span<const double> joint_weight,
                      const std::optional<recon::JointOrientations>& orientation) {
  controlled = true;
  wanted_orientation = orientation;
  Posture known = target;
  for (size_t i = 0; i < kJointCount; ++i) {
    const double w = joint_weight.empty() ? 1.0 : joint_weight[i];
    Vector3d& p = known.position_m[i];
    const bool is_known = p.allFinite() && p.cwiseAbs().maxCoeff() < kFarthest_m && w > 0.0;
    weight[i] = is_known ? std::clamp(w, 0.0, 1.0) : 0.0;
    if (!is_known) p.setConstant(std::nan(""));
  }
  wanted = recon::FilledFrom(character.posture(), known);
}

recon::JointOrientations Actor::OrientAim() const {
  if (!wanted_orientation) return recon::ComputeOrientations(aim);
  return recon::AlignToBones(*wanted_orientation, aim);
}

/// This frame's target: the requested posture, user constraints, and the floor.
Posture Actor::Goal(recon::JointArray<double>& trust) const {
  Posture goal = wanted;
  if (!lean_rad.isZero()) LeanBy(lean_rad, goal);
  for (const auto& [joint, place] : soft_constraint) {
    goal.position_m[joint] = place.Now();
    trust[joint] = kConstrainedWeight;
  }
  for (const auto& [joint, pin] : hard_constraint) {
    goal.position_m[joint] = pin->place_m();
    trust[joint] = kConstrainedWeight;
  }
  if (dodge_left_s > 0.0) RaiseForearms(lengths, goal);
  return goal;
}

void Actor::WatchFor(const ObjectState& thing, double radius_m, const Vector3d& gravity_m_s2) {
  constexpr double kRoom_m = 0.25;  // a head's radius, and as much again
  constexpr double kHold_s = 0.3;   // until the object has passed
  for (const recon::Joint joint : {recon::Joint::kHead, recon::Joint::kShoulderCenter}) {
    // The target without lean: an already leaning head is out of the way.
    const auto way = EscapeFrom(thing, wanted[joint], kRoom_m + radius_m, gravity_m_s2);
    if (!way) continue;
    if (lean_left_s <= 0.0) escape = *way;
    lean_left_s = kHold_s;
    return;
  }
}

void Actor::Prepare(OdeWorld& ode, const std::optional<Vector4d>& floor, double dt_s) {
  const double sole_m = SoleHeight();
  recon::JointArray<double> trust = weight;
  SetLean(floor, dt_s);
  Posture goal = Goal(trust);
  LiftOntoFloor(floor, sole_m, goal);
  if (options.pin_feet) {
    for (FootPin& foot : foot_pin) {
      foot.Update(ode, character, floor, goal.position_m[foot.joint()], dt_s);
      if (foot.pin() == nullptr) continue;
      goal.position_m[foot.joint()] = foot.pin()->place_m();
      trust[foot.joint()] = kConstrainedWeight;
    }
  }
  last_aim = aim;
  aim = FitBoneLengths(goal, lengths, trust);
  if (limits != nullptr) aim = WithinRanges(aim);
  if (LiftOntoFloor(floor, sole_m, aim)) aim = FitBoneLengths(aim, lengths, trust);
  aim_orientation = OrientAim();
  for (size_t i = 0; i < kJointCount; ++i) {
    SetLead(i, floor, sole_m, dt_s);
    control.stiffness[i] =
        controlled ? kLeastStiffness + (1.0 - kLeastStiffness) * std::min(trust[i], 1.0) : 0.0;
  }
  for (size_t i = 1; i < kJointCount; ++i) {
    // A bone's angular velocity from the difference of its end velocities.
    const auto parent = recon::ParentOf(i);
    const Vector3d bone = aim.position_m[i] - aim.position_m[parent];
    control.angular_velocity_rad_s[i] =
        bone.cross(aim_velocity_m_s[i] - aim_velocity_m_s[parent]) / bone.squaredNorm();
  }
}

/// Leaning is fast, but takes more than a frame.
void Actor::SetLean(const std::optional<Vector4d>& floor, double dt_s) {
  constexpr double kLean_rad = 0.65;     // moves the head 0.4 m aside
  constexpr double kWay_s = 0.07;        // time constant
  constexpr double kUpright_rad = 1e-3;  // below visibility
  const Vector3d up = floor ? Vector3d(floor->head<3>()) : Vector3d::UnitY();
  const Vector3d wanted_rad =
      lean_left_s > 0.0 ? Vector3d(kLean_rad * up.cross(escape)) : Vector3d::Zero();
  lean_rad += (1.0 - std::exp(-dt_s / kWay_s)) * (wanted_rad - lean_rad);
  if (wanted_rad.isZero() && lean_rad.norm() < kUpright_rad) lean_rad.setZero();
  lean_left_s = std::max(0.0, lean_left_s - dt_s);
}

void Actor::SetLead(size_t joint, const std::optional<Vector4d>& floor, double sole_m,
                    double dt_s) {
  const Vector3d& p = aim.position_m[joint];
  Vector3d velocity = (p - last_aim.position_m[joint]) / dt_s;
  const double speed = velocity.norm();
  if (speed > kLargestSpeed_m_s) velocity *= kLargestSpeed_m_s / speed;
  velocity = Lead(joint, velocity, dt_s);
  if (floor) {
    // A descending foot stops at the floor, whatever its speed.
    const double below = sole_m - HeightAbove(*floor, p + dt_s * velocity);
    const double down = -floor->head<3>().dot(velocity);
    if (below > 0.0 && down > 0.0) velocity += std::min(down, below / dt_s) * floor->head<3>();
  }
  aim_velocity_m_s[joint] = velocity;
}

/// The part of a joint's velocity that the controller gets as feed-forward. A spring alone lags 2 /
/// w behind steady motion. Noise moves a joint back and forth, motion moves it on: the ratio of
/// mean velocity to mean speed distinguishes them without a noise level. Only the mean velocity is
/// passed on. Departure from eq. 1, which differentiates the target and so passes on the sensor's
/// jitter. The thresholds are from a sweep on UI-PRMD and noisy motion capture.
Vector3d Actor::Lead(size_t joint, const Vector3d& velocity_m_s, double dt_s) {
  constexpr double kMemory_s = 0.077;
  constexpr double kNoiseRatio = 0.4, kMotionRatio = 0.8;  // ratio of speeds
  constexpr double kSlow_m_s = 0.05, kFast_m_s = 0.3;
  const double share = 1.0 - std::exp(-dt_s / kMemory_s);
  Vector3d& mean = mean_velocity_m_s[joint];
  double& mean_speed = mean_speed_m_s[joint];
  mean += share * (velocity_m_s - mean);
  mean_speed += share * (velocity_m_s.norm() - mean_speed);
  const double speed = mean.norm();
  // After a stop there is no further motion: a jump must not echo.
  const double going_on =
      std::clamp(velocity_m_s.dot(mean) / std::max(speed * speed, 1e-12), 0.0, 1.0);
  return options.lead * SmoothStep(speed / (mean_speed + 1e-9), kNoiseRatio, kMotionRatio) *
         SmoothStep(speed, kSlow_m_s, kFast_m_s) * going_on * mean;
}

void Actor::Drive(const Vector3d& gravity_m_s2, double left_s, double h_s) {
  for (size_t i = 0; i < kJointCount; ++i) {
    control.position_m[i] = aim.position_m[i] - left_s * aim_velocity_m_s[i];
    control.velocity_m_s[i] = aim_velocity_m_s[i];
    const Vector3d ahead = left_s * control.angular_velocity_rad_s[i];
    control.orientation[i] =
        Eigen::AngleAxisd(-ahead.norm(), ahead.stableNormalized()) * aim_orientation[i];
  }
  character.Drive(control, options.gains, gravity_m_s2, h_s);
  if (limits != nullptr) limits->Update(h_s);
  for (const auto& [joint, impulse] : pushes) character.AddForceAtJoint(joint, impulse / h_s);
  pushes.clear();
  for (const auto& [joint, force] : pulls) character.AddForceAtJoint(joint, force);
  for (FootPin& foot : foot_pin) {
    if (foot.pin() != nullptr) foot.pin()->Update(h_s);
  }
  for (auto& [joint, pin] : hard_constraint) pin->Update(h_s);
}

}  // namespace ossa::physics
