#include "physics/world.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "physics/world_internal.h"

namespace ossa::physics {
namespace {

using Eigen::Vector3d;
using Eigen::Vector4d;

void Require(bool good, const std::string& name, double value, const std::string& range) {
  if (!good) {
    throw std::invalid_argument(name + " = " + std::to_string(value) + ", must be in " + range);
  }
}

// Constants: chosen by hand unless stated otherwise.

constexpr double kFrame_s = 1.0 / 30.0;
constexpr double kDodgeHold_s = 0.3;
constexpr double kDeepest_m = 0.004;  // maximum penetration of the floor
/// Maximum displacement of an object per substep: the margin in which its contact with a limb is
/// detected.
constexpr double kUnseen_m = kContactMargin_m;
constexpr double kFastest_m_s = 45.0;  // faster objects get more substeps; a fast ball game's throw

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
  const auto check_size = [](const Vector3d& size_m) {
    Require(size_m.allFinite() && size_m.minCoeff() >= 0.005 && size_m.maxCoeff() <= 100.0,
            "size_m", size_m.minCoeff(), "[0.005, 100]");
  };
  check_size(size_m);
  for (const ObjectPart& part : parts) check_size(part.size_m);
  Require(mass_kg >= 1e-3 && mass_kg <= 1e5, "mass_kg", mass_kg, "[0.001, 1e5]");
  Require(friction >= 0.0 && friction <= 10.0, "friction", friction, "[0, 10]");
  Require(bounce >= 0.0 && bounce < 1.0, "bounce", bounce, "[0, 1)");
}

World::Impl::Impl(const WorldOptions& world_options)
    : options(world_options), gravity_m_s2(0.0, -world_options.gravity_m_s2, 0.0) {
  dWorldSetERP(ode.world, 0.4);
  dWorldSetCFM(ode.world, 1e-9);
  SetIterations();
  dWorldSetContactMaxCorrectingVel(ode.world, 2.0);
  dWorldSetContactSurfaceLayer(ode.world, 0.0005);
  dWorldSetGravity(ode.world, gravity_m_s2.x(), gravity_m_s2.y(), gravity_m_s2.z());
}

World::Impl::~Impl() {
  for (auto& [id, actor] : actors) actor->hard_constraint.clear();  // before the objects they pull
  for (auto& [id, thing] : things) DestroyThing(thing);
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

void World::Impl::WatchThreats(double dt_s) {
  for (const auto& [id, actor] : actors) {
    if (actor->options.lean) WatchForThings(*actor);
    if (!actor->options.dodge) continue;
    actor->dodge_left_s = std::max(0.0, actor->dodge_left_s - dt_s);
    const auto head = recon::Index(recon::Joint::kHead);
    for (const auto& [number, thing] : things) {
      if (!thing.grips.empty() || thing.info.kind == BodyKind::kStatic) continue;
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

void World::Impl::WatchForThings(Actor& actor) const {
  for (const auto& [number, thing] : things) {
    if (!thing.grips.empty() || thing.info.kind == BodyKind::kStatic) continue;
    const Vector3d size_m =
        thing.info.shape == Shape::kBox ? thing.info.size_m : Vector3d(thing.info.size_m.x(), 0, 0);
    actor.WatchFor({ToEigen(dBodyGetPosition(thing.body)), Eigen::Quaterniond::Identity(),
                    ToEigen(dBodyGetLinearVel(thing.body))},
                   0.5 * size_m.norm(), gravity_m_s2);
  }
}

void World::Impl::Substep(double left_s, double h_s) {
  if (callbacks.before_substep) callbacks.before_substep(h_s);
  for (const auto& [id, actor] : actors) actor->Drive(gravity_m_s2, left_s, h_s);
  for (const auto& [id, thing] : things) {
    for (const Load& load : thing.loads) {
      const auto& [f, t, at] = load;
      dBodyAddForceAtRelPos(thing.body, f.x(), f.y(), f.z(), at.x(), at.y(), at.z());
      dBodyAddTorque(thing.body, t.x(), t.y(), t.z());
    }
  }
  ShareCarriedWeight();
  Collide(h_s);
  SeededQuickStep(ode.world, h_s, options.seed + 0x9e3779b9U * ++steps);
  GatherImpulses(h_s);
  BreakHolds();
  SlipGrips(h_s);
  dJointGroupEmpty(ode.contacts);
  RescueLost();
  for (const auto& [id, actor] : actors) {
    actor->max_gap_m = std::max(actor->max_gap_m, actor->character.MaxAnchorGap());
    actor->character.Reconnect();
    if (floor) actor->character.LiftOutOf(*floor, kDeepest_m);
  }
}

/// Bounded forces keep motion finite, but an extreme impulse may not. A character with non-finite
/// motion is placed at its target with the objects it holds; an object is placed at rest where it
/// was before the step. Immediately, because ODE terminates the process when it checks contacts of
/// non-finite positions.
void World::Impl::RescueLost() {
  for (const auto& [id, actor] : actors) {
    if (actor->character.IsFinite()) continue;
    ++actor->rescued;
    Place(*actor, actor->aim);
  }
  for (auto& [id, thing] : things) {
    if (!IsFiniteAndNear(thing.body)) SetPoseAtRest(thing.body, thing.before);
  }
}

void World::Impl::BreakHolds() {
  for (auto& [id, thing] : things) {
    const auto is_torn = [](const Grip& grip) {
      return grip.feedback && ToEigen(grip.feedback->f1).norm() > grip.strength_n;
    };
    if (std::none_of(thing.grips.begin(), thing.grips.end(), is_torn)) continue;
    Release(thing, is_torn);
    contacts.broken.push_back(id);
  }
}

double World::Impl::FastestThing_m_s() const {
  double fastest_m_s = 0.0;
  for (const auto& [id, thing] : things) {
    fastest_m_s = std::max(fastest_m_s, ToEigen(dBodyGetLinearVel(thing.body)).norm());
  }
  return fastest_m_s;
}

/// Sets velocities of kinematic objects so that they arrive after dt.
void World::Impl::MoveKinematic(double dt_s) {
  for (auto& [id, thing] : things) {
    thing.before = PoseOf(thing.body);
    if (!thing.goal) continue;
    const Eigen::AngleAxisd turn(thing.goal->linear() * thing.before.linear().transpose());
    const Vector3d v = (thing.goal->translation() - thing.before.translation()) / dt_s;
    const Vector3d w = turn.angle() / dt_s * turn.axis();
    dBodySetLinearVel(thing.body, v.x(), v.y(), v.z());
    dBodySetAngularVel(thing.body, w.x(), w.y(), w.z());
  }
}

/// Clears per-step state and reports contacts.
void World::Impl::FinishStep(const std::vector<Contact>& before) {
  for (auto& [id, actor] : actors) actor->pulls.clear();
  for (auto& [id, thing] : things) {
    thing.loads.clear();
    if (thing.goal) SetPoseAtRest(thing.body, *thing.goal);
    thing.goal.reset();
  }
  for (auto& touched : touching) {
    Contact& contact = touched.second;
    contact.began = std::none_of(before.begin(), before.end(), [&contact](const Contact& other) {
      return other.a == contact.a && other.b == contact.b;
    });
    contacts.contacts.push_back(std::move(contact));
  }
  touching.clear();
  if (callbacks.on_first_contact) {
    for (const Contact& contact : contacts.contacts) {
      if (contact.began) callbacks.on_first_contact(contact);
    }
  }
  if (callbacks.on_broken_hold) {
    for (const int object : contacts.broken) callbacks.on_broken_hold(object);
  }
}

void World::Step(double dt_s) {
  Require(dt_s > 0.0 && dt_s <= 0.25, "Step: dt_s", dt_s, "(0, 0.25]");
  PrepareOde();
  Impl& w = *impl_;
  w.WatchThreats(dt_s);
  for (const auto& [id, actor] : w.actors) {
    actor->max_gap_m = 0.0;
    actor->Prepare(w.ode, w.floor, dt_s);
  }
  const double fewest = std::max(dt_s / kFrame_s * w.options.substeps,
                                 dt_s * std::min(w.FastestThing_m_s(), kFastest_m_s) / kUnseen_m);
  const int count = std::max(1, static_cast<int>(std::ceil(fewest - 1e-6)));
  const double h = dt_s / count;
  const std::vector<Contact> before = std::move(w.contacts.contacts);
  w.contacts = {};
  w.MoveKinematic(dt_s);
  for (int k = 0; k < count; ++k) w.Substep(dt_s - (k + 1) * h, h);
  w.FinishStep(before);
}

const ContactSummary& World::Contacts() const { return impl_->contacts; }
std::optional<Vector4d> World::Floor() const { return impl_->floor; }
void World::SetCallbacks(WorldCallbacks callbacks) { impl_->callbacks = std::move(callbacks); }

}  // namespace ossa::physics
