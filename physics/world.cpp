#include "physics/world.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "physics/world_internal.h"
#include "recon/orientation.h"

namespace ossa::physics {
namespace {

using Eigen::Vector3d;
using Eigen::Vector4d;

void Require(bool good, const std::string& name, double value, const std::string& range) {
  if (!good) {
    throw std::invalid_argument(name + " = " + std::to_string(value) + ", must be in " + range);
  }
}

// Constants: chosen by hand, where nothing else is said.

constexpr double kFrame_s = 1.0 / 30.0;
constexpr double kDodgeHold_s = 0.3;
/// Of the constraint solver. Servo motors have twice the rows; fewer iterations keep them below the
/// 0.6 ms a frame and their pinned feet still within 5 mm (3.5 mm at 30, 4.7 at 26, 5.2 at 24).
constexpr int kIterations = 30, kMotorIterations = 26;
constexpr double kDeepest_m = 0.004;  // nobody stands deeper in the floor

}  // namespace

void WorldOptions::Check() const {
  Require(substeps >= 5 && substeps <= 100, "substeps", substeps, "[5, 100]");
  Require(gravity_m_s2 >= 0.0 && gravity_m_s2 <= 100.0, "gravity_m_s2", gravity_m_s2, "[0, 100]");
  Require(floor_friction >= 0.0 && floor_friction <= 10.0, "floor_friction", floor_friction,
          "[0, 10]");
}

void CharacterOptions::Check(double step_s) const {
  const double largest = LargestStableRate(step_s);
  Require(gains.rate_rad_s > 0.0 && gains.rate_rad_s <= largest, "gains.rate_rad_s",
          gains.rate_rad_s, "(0, " + std::to_string(largest) + "] at this many substeps");
  Require(gains.max_acceleration_m_s2 > 0.0 && gains.max_acceleration_m_s2 <= 1e5,
          "gains.max_acceleration_m_s2", gains.max_acceleration_m_s2, "(0, 1e5]");
  Require(lead >= 0.0 && lead <= 1.0, "lead", lead, "[0, 1]");
  Require(stature_m == 0.0 || (stature_m >= 0.4 && stature_m <= 2.6), "stature_m", stature_m,
          "[0.4, 2.6] or 0");
  Require(mass_kg == 0.0 || (mass_kg >= 3.0 && mass_kg <= 400.0), "mass_kg", mass_kg,
          "[3, 400] or 0");
}

void ObjectOptions::Check() const {
  Require(size_m.allFinite() && size_m.minCoeff() >= 0.005 && size_m.maxCoeff() <= 100.0, "size_m",
          size_m.minCoeff(), "[0.005, 100]");
  Require(mass_kg >= 1e-3 && mass_kg <= 1e5, "mass_kg", mass_kg, "[0.001, 1e5]");
  Require(friction >= 0.0 && friction <= 10.0, "friction", friction, "[0, 10]");
  Require(bounce >= 0.0 && bounce < 1.0, "bounce", bounce, "[0, 1)");
}

World::Impl::Impl(const WorldOptions& world_options)
    : options(world_options), gravity_m_s2(0.0, -world_options.gravity_m_s2, 0.0) {
  dWorldSetERP(ode.world, 0.4);
  dWorldSetCFM(ode.world, 1e-9);
  dWorldSetQuickStepNumIterations(ode.world, kIterations);
  dWorldSetContactMaxCorrectingVel(ode.world, 2.0);
  dWorldSetContactSurfaceLayer(ode.world, 0.0005);
  dWorldSetGravity(ode.world, gravity_m_s2.x(), gravity_m_s2.y(), gravity_m_s2.z());
}

World::Impl::~Impl() {
  for (Thing& thing : things) {
    if (thing.held != nullptr) dJointDestroy(thing.held);
    dGeomDestroy(thing.geom);
    dBodyDestroy(thing.body);
  }
  for (const dGeomID geom : {floor_geom, limb_floor_geom, probe}) dGeomDestroy(geom);
}

World::World(const WorldOptions& options) {
  options.Check();
  impl_ = std::make_unique<Impl>(options);
}
World::~World() = default;
World::World(World&&) noexcept = default;
World& World::operator=(World&&) noexcept = default;

void World::SetFloor(const std::optional<Vector4d>& floor) {
  Impl& w = *impl_;
  const bool usable = floor && floor->allFinite() && floor->head<3>().norm() > 1e-6;
  w.floor.reset();
  Vector3d up = Vector3d::UnitY();
  if (usable) {
    w.floor = *floor / floor->head<3>().norm();
    up = w.floor->head<3>();
    const Vector4d& p = *w.floor;
    dGeomPlaneSetParams(w.floor_geom, p[0], p[1], p[2], -p[3]);
    dGeomPlaneSetParams(w.limb_floor_geom, p[0], p[1], p[2], kFloorLook_m - p[3]);
  }
  w.gravity_m_s2 = -w.options.gravity_m_s2 * up;
  dWorldSetGravity(w.ode.world, w.gravity_m_s2.x(), w.gravity_m_s2.y(), w.gravity_m_s2.z());
}

int World::AddCharacter(const recon::BoneLengths& lengths, const recon::Posture& start,
                        const CharacterOptions& options) {
  options.Check(kFrame_s / impl_->options.substeps);
  if (options.control == Control::kMotor) {
    dWorldSetQuickStepNumIterations(impl_->ode.world, kMotorIterations);
  }
  auto& actors = impl_->actors;
  actors.push_back(
      std::make_unique<Actor>(impl_->ode, lengths, options, static_cast<int>(actors.size()) + 1));
  actors.back()->Place(start, impl_->floor);
  return static_cast<int>(actors.size()) - 1;
}

void World::SetTarget(int character, const recon::Posture& target, std::span<const double> weight,
                      const std::optional<recon::JointOrientations>& orientation) {
  if (!weight.empty() && weight.size() != recon::kJointCount) {
    throw std::invalid_argument("SetTarget: " + std::to_string(weight.size()) +
                                " weights, must be 20 or none");
  }
  impl_->actors.at(static_cast<size_t>(character))->SetTarget(target, weight, orientation);
}

void World::LetGo(int character) {
  impl_->actors.at(static_cast<size_t>(character))->controlled = false;
}

void World::Place(int character, const recon::Posture& posture,
                  const std::optional<recon::JointOrientations>& orientation) {
  Actor& actor = *impl_->actors.at(static_cast<size_t>(character));
  actor.wanted_orientation = orientation;
  impl_->Place(actor, posture);
}

void World::Impl::Place(Actor& actor, const recon::Posture& posture) {
  struct Carried {
    Thing* thing;
    Eigen::Isometry3d in_hand;
  };
  std::vector<Carried> carried;
  for (Thing& thing : things) {
    if (thing.hand == nullptr || !actor.character.Owns(thing.hand)) continue;
    // As it is held now; where nothing is known of now, as it was when it was taken.
    const Eigen::Isometry3d now = PoseOf(thing.hand).inverse() * PoseOf(thing.body);
    carried.push_back({&thing, now.matrix().allFinite() ? now : thing.in_hand});
  }
  actor.Place(posture, floor);
  for (const auto& [thing, in_hand] : carried) {
    SetPoseAtRest(thing->body, PoseOf(thing->hand) * in_hand);
  }
}

void World::SetVelocity(int character, const Vector3d& velocity_m_s) {
  Character& moved = impl_->actors.at(static_cast<size_t>(character))->character;
  moved.SetVelocity(velocity_m_s);
  for (const Thing& thing : impl_->things) {
    if (thing.hand == nullptr || !moved.Owns(thing.hand)) continue;
    dBodySetLinearVel(thing.body, velocity_m_s.x(), velocity_m_s.y(), velocity_m_s.z());
    dBodySetAngularVel(thing.body, 0, 0, 0);
  }
}

void World::Constrain(int character, recon::Joint joint, const Vector3d& place_m, bool hard) {
  Actor& actor = *impl_->actors.at(static_cast<size_t>(character));
  const auto index = recon::Index(joint);
  Unconstrain(character, joint);
  if (!place_m.allFinite()) throw std::invalid_argument("Constrain: place must be finite");
  constexpr double kStiffness_n_m = 2e4;
  if (hard) {
    actor.hard_constraint[index] =
        std::make_unique<Pin>(impl_->ode, actor.character, index, place_m, kStiffness_n_m);
  } else {
    actor.soft_constraint[index] = place_m;
  }
}

void World::Unconstrain(int character, recon::Joint joint) {
  Actor& actor = *impl_->actors.at(static_cast<size_t>(character));
  actor.soft_constraint.erase(recon::Index(joint));
  actor.hard_constraint.erase(recon::Index(joint));
}

void World::Push(int character, recon::Joint joint, const Vector3d& impulse_ns) {
  if (!impulse_ns.allFinite()) throw std::invalid_argument("Push: impulse must be finite");
  impl_->actors.at(static_cast<size_t>(character))
      ->pushes.emplace_back(recon::Index(joint), impulse_ns);
}

void World::Impl::WatchThreats(double dt_s) {
  for (const auto& actor : actors) {
    if (!actor->options.dodge) continue;
    actor->dodge_left_s = std::max(0.0, actor->dodge_left_s - dt_s);
    const auto head = recon::Index(recon::Joint::kHead);
    for (const Thing& thing : things) {
      if (thing.held != nullptr) continue;
      const ObjectState state = {ToEigen(dBodyGetPosition(thing.body)),
                                 Eigen::Quaterniond::Identity(),
                                 ToEigen(dBodyGetLinearVel(thing.body))};
      if (ThreatTo(actor->character.JointPosition(head), actor->character.JointVelocity(head),
                   state)) {
        actor->dodge_left_s = kDodgeHold_s;
      }
    }
  }
}

void World::Impl::Substep(double left_s, double h_s) {
  for (const auto& actor : actors) actor->Drive(gravity_m_s2, left_s, h_s);
  Collide(h_s);
  SeededQuickStep(ode.world, h_s, options.seed + 0x9e3779b9U * ++steps);
  dJointGroupEmpty(ode.contacts);
  RescueLost();
  for (const auto& actor : actors) {
    actor->max_gap_m = std::max(actor->max_gap_m, actor->character.MaxAnchorGap());
    actor->character.Reconnect();
    if (floor) actor->character.LiftOutOf(*floor, kDeepest_m);
  }
}

/// Bounded forces keep motion finite; an absurd impulse may not. A character whose motion is lost
/// stands up at its target with what it holds, a thing rests where it was before the step. At once:
/// ODE ends the process when it is to look for contacts of what is nowhere.
void World::Impl::RescueLost() {
  for (const auto& actor : actors) {
    if (actor->character.IsFinite()) continue;
    ++actor->rescued;
    Place(*actor, actor->aim);
  }
  for (Thing& thing : things) {
    if (!IsFiniteAndNear(thing.body)) SetPoseAtRest(thing.body, thing.before);
  }
}

void World::Step(double dt_s) {
  Require(dt_s > 0.0 && dt_s <= 0.25, "Step: dt_s", dt_s, "(0, 0.25]");
  PrepareOde();
  Impl& w = *impl_;
  w.WatchThreats(dt_s);
  for (const auto& actor : w.actors) {
    actor->max_gap_m = 0.0;
    actor->Prepare(w.ode, w.floor, dt_s);
  }
  const int count =
      std::max(1, static_cast<int>(std::ceil(dt_s / kFrame_s * w.options.substeps - 1e-6)));
  const double h = dt_s / count;
  w.contacts = {};
  for (Thing& thing : w.things) thing.before = PoseOf(thing.body);
  for (int k = 0; k < count; ++k) w.Substep(dt_s - (k + 1) * h, h);
}

CharacterState World::StateOf(int character) const {
  const Actor& actor = *impl_->actors.at(static_cast<size_t>(character));
  CharacterState state;
  state.posture = actor.character.posture();
  state.orientation = actor.character.orientation();
  state.orientation[0] = recon::ComputeOrientations(state.posture)[0];
  state.left_foot_pinned = actor.foot_pin[0].pin() != nullptr;
  state.right_foot_pinned = actor.foot_pin[1].pin() != nullptr;
  state.dodging = actor.dodge_left_s > 0.0;
  state.max_anchor_gap_m = actor.character.MaxAnchorGap();
  state.max_solver_gap_m = actor.max_gap_m;
  state.rescued = actor.rescued;
  state.momentum_kg_m_s = actor.character.Momentum();
  return state;
}

const ContactSummary& World::Contacts() const { return impl_->contacts; }
bool World::IsFinite(int character) const {
  return impl_->actors.at(static_cast<size_t>(character))->character.IsFinite();
}
int World::CharacterCount() const { return static_cast<int>(impl_->actors.size()); }
int World::ObjectCount() const { return static_cast<int>(impl_->things.size()); }
std::optional<Vector4d> World::Floor() const { return impl_->floor; }

}  // namespace ossa::physics
