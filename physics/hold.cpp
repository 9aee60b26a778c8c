// Holds objects: by hands, or at fixed points.
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "physics/world_internal.h"

namespace ossa::physics {

using Eigen::Vector3d;

namespace {

// Constants: by hand.

/// Damping of slipping hands that press on each other through a held object: with an arm stiffness
/// of 200 to 2000 N/m, the time constant is a fifth of a second to two.
constexpr double kSlip_ns_m = 400.0;
/// Speed limit: a body behind a straight arm may press with kilonewtons.
constexpr double kFastestSlip_m_s = 1.0;
/// Hands slip along the object's surface: no nearer than a hand's thickness, and off it no farther
/// than the compliance of arms. Hands that move farther apart than that release the hold.
constexpr double kHandOffSurface_m = 0.03;
constexpr double kFurtherOff_m = 0.2;

/// ODE takes the second anchor in the second body's frame.
void SetAnchorOnThing(const Grip& grip) {
  const Vector3d& at = *grip.on_thing_m;
  dJointSetBallAnchor2(grip.joint, at.x(), at.y(), at.z());
}

/// Force of the hand on the object in the last substep, world axes.
Vector3d PullOnThing(const Grip& grip) { return -ToEigen(grip.feedback->f1); }

/// All hands that hold an object and may slip on it.
struct Together {
  std::vector<Grip*> grips;
  Vector3d sum_m = Vector3d::Zero(), sum_n = Vector3d::Zero();

  void Add(Grip& grip) {
    grips.push_back(&grip);
    sum_m += *grip.on_thing_m;
    sum_n += PullOnThing(grip);
  }
  Vector3d Middle_m() const { return sum_m / static_cast<double>(grips.size()); }
  Vector3d Mean_n() const { return sum_n / static_cast<double>(grips.size()); }
};

/// An angular motor with zero speed: resists relative rotation with limited torque.
dJointID MakeTurningFriction(dWorldID world, dBodyID hand, dBodyID thing, double torque_nm) {
  const dJointID motor = dJointCreateAMotor(world, nullptr);
  dJointAttach(motor, hand, thing);
  dJointSetAMotorMode(motor, dAMotorUser);
  dJointSetAMotorNumAxes(motor, 3);
  constexpr int kOfHand = 1;  // axes are fixed to the first body
  for (int axis = 0; axis < 3; ++axis) {
    const dReal* turn = dBodyGetRotation(hand);  // rows of four
    dJointSetAMotorAxis(motor, axis, kOfHand, turn[axis], turn[4 + axis], turn[8 + axis]);
    const int of_axis = axis * dParamGroup;
    dJointSetAMotorParam(motor, dParamVel + of_axis, 0.0);
    dJointSetAMotorParam(motor, dParamFMax + of_axis, torque_nm);
  }
  return motor;
}

}  // namespace

void World::Impl::Connect(const Thing& thing, Grip& grip) {
  const bool turns = !grip.rigid || std::isfinite(grip.torque_nm);
  const dBodyID first = grip.hand == nullptr ? thing.body : grip.hand;
  const dBodyID second = grip.hand == nullptr ? nullptr : thing.body;
  grip.joint = turns ? dJointCreateBall(ode.world, nullptr) : dJointCreateFixed(ode.world, nullptr);
  dJointAttach(grip.joint, first, second);
  if (!turns) {
    dJointSetFixed(grip.joint);
    return;
  }
  dJointSetBallAnchor(grip.joint, grip.point_m.x(), grip.point_m.y(), grip.point_m.z());
  if (!grip.rigid) return;
  grip.turning = MakeTurningFriction(ode.world, first, second, grip.torque_nm);
  if (!grip.on_thing_m) {
    grip.on_thing_m = PoseOf(thing.body).inverse() * grip.point_m;
    grip.taken_off_m = DistanceToObject(thing.info, *grip.on_thing_m + thing.middle_m);
  }
  SetAnchorOnThing(grip);
}

/// Several holders of an object each compensate their share of its weight, as for their own limbs.
void World::Impl::ShareCarriedWeight() {
  for (const auto& [id, thing] : things) {
    const auto slips = [](const Grip& grip) { return grip.turning != nullptr; };
    const auto hands = std::count_if(thing.grips.begin(), thing.grips.end(), slips);
    if (hands < 2 || !thing.IsMoved()) continue;
    dMass mass;
    dBodyGetMass(thing.body, &mass);
    const Vector3d share_n = -mass.mass / static_cast<double>(hands) * gravity_m_s2;
    for (const Grip& grip : thing.grips) {
      Actor& actor = ActorOf(grip.character);
      if (slips(grip) && actor.controlled) actor.character.AddForceAtJoint(grip.bone, share_n);
    }
  }
}

/// Hands that hold an object together and are nearer to each other, or farther apart, than when
/// they took it would work against each other through it, and no arm could follow its target. They
/// slip along the line between them with viscous friction.
void World::Impl::SlipGrips(double h_s) {
  for (auto& [id, thing] : things) {
    Together together;
    for (Grip& grip : thing.grips) {
      if (grip.turning != nullptr) together.Add(grip);
    }
    if (together.grips.size() < 2) continue;
    const Eigen::Matrix3d thing_from_world = PoseOf(thing.body).linear().transpose();
    for (Grip* const grip : together.grips) {
      const Vector3d outwards = (*grip->on_thing_m - together.Middle_m()).stableNormalized();
      const Vector3d against_n = thing_from_world * (PullOnThing(*grip) - together.Mean_n());
      const Vector3d to_m =
          *grip->on_thing_m + h_s *
                                  std::clamp(outwards.dot(against_n) / kSlip_ns_m,
                                             -kFastestSlip_m_s, kFastestSlip_m_s) *
                                  outwards;
      const double off_m = DistanceToObject(thing.info, to_m + thing.middle_m);
      // Also false for a NaN force.
      if (!(off_m >= std::min(grip->taken_off_m, kHandOffSurface_m) &&
            off_m <= std::max(grip->taken_off_m, kHandOffSurface_m) + kFurtherOff_m)) {
        continue;
      }
      grip->on_thing_m = to_m;
      SetAnchorOnThing(*grip);
    }
  }
}

void World::Impl::Take(Thing& thing, Grip grip) {
  const bool hangs = grip.character < 0;
  if (!hangs) {
    const Character& character = ActorOf(grip.character).character;
    grip.hand = character.body(grip.bone);
    grip.beside = character.body(BodyParentOf(grip.bone));
    grip.in_hand = physics::PoseOf(grip.hand).inverse() * physics::PoseOf(thing.body);
    grip.hand_then = Remember(grip.hand);
  }
  grip.thing_then = Remember(thing.body);
  grip.made = ode.made++;
  Connect(thing, grip);
  if (std::isfinite(grip.strength_n) || grip.turning != nullptr) {
    grip.feedback = std::make_unique<dJointFeedback>();
    dJointSetFeedback(grip.joint, grip.feedback.get());
  }
  thing.grips.push_back(std::move(grip));
}

void World::Hold(int character, recon::Joint joint, int object, bool rigid, double strength_n,
                 double torque_nm) {
  Thing& thing = impl_->things.at(object);
  if (!(strength_n > 0.0)) throw std::invalid_argument("Hold: strength_n must be above 0");
  if (!(torque_nm > 0.0)) throw std::invalid_argument("Hold: torque_nm must be above 0");
  const Character& hand = impl_->ActorOf(character).character;
  Grip grip;
  grip.character = character;
  grip.bone = hand.BodyOfJoint(recon::Index(joint));
  grip.rigid = rigid;
  grip.strength_n = strength_n;
  grip.torque_nm = torque_nm;
  grip.point_m = hand.JointPosition(recon::Index(joint));
  Impl::Release(thing, [&grip](const Grip& other) {
    return other.character < 0 || (other.character == grip.character && other.bone == grip.bone);
  });
  impl_->Take(thing, std::move(grip));
}

void World::Hang(int object, const Vector3d& point_m) {
  Grip grip;
  grip.point_m = point_m;
  grip.strength_n = std::numeric_limits<double>::infinity();
  Thing& thing = impl_->things.at(object);
  Impl::Release(thing);
  impl_->Take(thing, std::move(grip));
}

void World::Impl::Release(Thing& thing, const std::function<bool(const Grip&)>& opens) {
  std::erase_if(thing.grips, [&opens](const Grip& grip) {
    if (!opens(grip)) return false;
    dJointDestroy(grip.joint);
    if (grip.turning != nullptr) dJointDestroy(grip.turning);
    return true;
  });
}

void World::Impl::Release(Thing& thing) {
  Release(thing, [](const Grip&) { return true; });
}

void World::Impl::ReleaseAllOf(int character) {
  for (auto& [id, thing] : things) {
    Release(thing, [character](const Grip& grip) { return grip.character == character; });
  }
}

void World::Release(int object) { Impl::Release(impl_->things.at(object)); }

void World::Release(int object, int character, recon::Joint joint) {
  const size_t bone = impl_->ActorOf(character).character.BodyOfJoint(recon::Index(joint));
  Impl::Release(impl_->things.at(object),
                [&](const Grip& grip) { return grip.character == character && grip.bone == bone; });
}

std::vector<Holder> World::HoldersOf(int object) const {
  std::vector<Holder> holders;
  for (const Grip& grip : impl_->things.at(object).grips) {
    if (grip.character >= 0) {
      holders.push_back({grip.character, static_cast<recon::Joint>(grip.bone)});
    }
  }
  return holders;
}

}  // namespace ossa::physics
