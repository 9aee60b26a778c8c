#include <algorithm>
#include <cmath>

#include "depth/error.h"
#include "physics/actor_internal.h"
#include "physics/retarget.h"
#include "recon/orientation.h"

namespace ossa::physics {
namespace {

using Eigen::Vector3d;
using Eigen::Vector4d;
using recon::kJointCount;
using recon::kJointParent;
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

/// A trust of 0 still follows, slowly: its place was filled in by someone who knew better.
constexpr double kLeastStiffness = 0.3;
constexpr double kFarthest_m = 1000.0;      // beyond is no place in a room
constexpr double kLargestSpeed_m_s = 15.0;  // of a target; a fast punch has 10

}  // namespace

Actor::Actor(OdeWorld& ode, const recon::BoneLengths& bone_lengths,
             const CharacterOptions& character_options, int tag)
    : lengths(Checked(bone_lengths)),
      options(character_options),
      character(ode, SegmentsOf(lengths, options.stature_m, options.mass_kg), options.control,
                tag) {
  weight.fill(1.0);
  aim_velocity_m_s.fill(Vector3d::Zero());
}

void Actor::Place(const Posture& posture) {
  std::array<double, kJointCount> even;
  even.fill(1.0);
  aim = wanted = last_aim = FitBoneLengths(posture, lengths, even);
  aim_velocity_m_s.fill(Vector3d::Zero());
  character.Place(aim, recon::OrientationsOf(aim));
  for (FootPin& pin : foot_pin) pin.Clear();
  hard_constraint.clear();
}

void Actor::SetTarget(const Posture& target, std::span<const double> joint_weight) {
  controlled = true;
  const Posture now = character.posture();
  for (size_t i = 0; i < kJointCount; ++i) {
    const double w = joint_weight.empty() ? 1.0 : joint_weight[i];
    const Vector3d& p = target.position_m[i];
    const bool known = p.allFinite() && p.cwiseAbs().maxCoeff() < kFarthest_m && w > 0.0;
    weight[i] = known ? std::clamp(w, 0.0, 1.0) : 0.0;
    if (known) {
      wanted.position_m[i] = p;
    } else if (i == 0) {
      wanted.position_m[i] = now.position_m[i];
    } else {
      const auto parent = static_cast<size_t>(kJointParent[i]);
      wanted.position_m[i] = wanted.position_m[parent] + now.position_m[i] - now.position_m[parent];
    }
  }
}

void Actor::Prepare(OdeWorld& ode, const std::optional<Vector4d>& floor, double dt_s) {
  Posture goal = wanted;
  std::array<double, kJointCount> trust = weight;
  for (const auto& [joint, place] : soft_constraint) {
    goal.position_m[joint] = place;
    trust[joint] = 1.0;
  }
  for (const auto& [joint, pin] : hard_constraint) goal.position_m[joint] = pin->place_m();
  if (dodge_left_s > 0.0) RaiseForearms(lengths, goal);
  const double sole_m = character.segments()[15].radius_m;
  if (floor) {
    // Nobody stands in the floor: what the sensor puts there is wanted on it.
    for (auto& p : goal.position_m) {
      const double below = sole_m - HeightAbove(*floor, p);
      if (below > 0.0) p += below * floor->head<3>();
    }
  }
  if (options.pin_feet) {
    for (FootPin& foot : foot_pin) {
      foot.Update(ode, character, floor, goal.position_m[foot.joint()], dt_s);
      if (foot.pin() != nullptr) goal.position_m[foot.joint()] = foot.pin()->place_m();
    }
  }
  last_aim = aim;
  aim = FitBoneLengths(goal, lengths, trust);
  control.orientation = recon::OrientationsOf(aim);
  for (size_t i = 0; i < kJointCount; ++i) {
    Vector3d velocity = (aim.position_m[i] - last_aim.position_m[i]) / dt_s;
    const double speed = velocity.norm();
    if (speed > kLargestSpeed_m_s) velocity *= kLargestSpeed_m_s / speed;
    aim_velocity_m_s[i] = options.lead * velocity;
    control.stiffness[i] = controlled ? kLeastStiffness + (1.0 - kLeastStiffness) * trust[i] : 0.0;
  }
}

void Actor::Drive(const Vector3d& gravity_m_s2, double left_s, double h_s) {
  for (size_t i = 0; i < kJointCount; ++i) {
    control.position_m[i] = aim.position_m[i] - left_s * aim_velocity_m_s[i];
    control.velocity_m_s[i] = aim_velocity_m_s[i];
  }
  character.Drive(control, options.gains, gravity_m_s2, h_s);
  for (const auto& [joint, impulse] : pushes) character.AddForceAtJoint(joint, impulse / h_s);
  pushes.clear();
  for (FootPin& foot : foot_pin) {
    if (foot.pin() != nullptr) foot.pin()->Update(h_s);
  }
  for (auto& [joint, pin] : hard_constraint) pin->Update(h_s);
}

}  // namespace ossa::physics
