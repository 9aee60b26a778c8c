// The characters of a world.
#include <algorithm>
#include <stdexcept>
#include <string>

#include "physics/world_internal.h"
#include "recon/orientation.h"

namespace ossa::physics {

using Eigen::Vector3d;

void World::Impl::SetIterations() {
  // By hand: servo motors have twice as many rows; fewer iterations keep them below 0.6 ms per
  // frame and their pinned feet within 5 mm (3.5 mm at 30, 4.7 at 26, 5.2 at 24).
  constexpr int kIterations = 30, kMotorIterations = 26;
  const bool motors = std::any_of(actors.begin(), actors.end(), [](const auto& actor) {
    return actor.second->options.control == Control::kMotor;
  });
  dWorldSetQuickStepNumIterations(ode.world, motors ? kMotorIterations : kIterations);
}

Actor& World::Impl::MakeActor(int character, const recon::BoneLengths& lengths,
                              const CharacterOptions& character_options) {
  auto& actor = actors[character] =
      std::make_unique<Actor>(ode, lengths, character_options, character + 1);
  SetIterations();
  return *actor;
}

int World::AddCharacter(const recon::BoneLengths& lengths, const recon::Posture& start,
                        const CharacterOptions& options) {
  Impl& w = *impl_;
  // The substeps of a frame of 1/30 s.
  options.Check(1.0 / 30.0 / w.options.substeps);
  Actor& actor = w.MakeActor(w.next_actor, lengths, options);
  actor.first = start;
  actor.Place(start, w.floor);
  return w.next_actor++;
}

void World::RemoveCharacter(int character) {
  impl_->ActorOf(character);  // throws if there is none
  impl_->ReleaseAllOf(character);
  impl_->actors.erase(character);
  impl_->SetIterations();
}

void World::ResetCharacter(int character) {
  Actor& actor = impl_->ActorOf(character);
  impl_->ReleaseAllOf(character);
  actor.soft_constraint.clear();
  actor.hard_constraint.clear();
  static_cast<ActorMemory&>(actor) = ActorMemory{};
  actor.Forget();
  actor.Place(actor.first, impl_->floor);
}

void World::SetTarget(int character, const recon::Posture& target, std::span<const double> weight,
                      const std::optional<recon::JointOrientations>& orientation) {
  if (!weight.empty() && weight.size() != recon::kJointCount) {
    throw std::invalid_argument("SetTarget: " + std::to_string(weight.size()) +
                                " weights, must be 20 or none");
  }
  impl_->ActorOf(character).SetTarget(target, weight, orientation);
}

void World::StopControl(int character) { impl_->ActorOf(character).controlled = false; }

void World::Place(int character, const recon::Posture& posture,
                  const std::optional<recon::JointOrientations>& orientation) {
  Actor& actor = impl_->ActorOf(character);
  actor.wanted_orientation = orientation;
  impl_->Place(actor, posture);
}

void World::Impl::Place(Actor& actor, const recon::Posture& posture) {
  std::vector<std::pair<Thing*, Eigen::Isometry3d>> carried;
  for (auto& [id, thing] : things) {
    const auto own = std::find_if(thing.grips.begin(), thing.grips.end(), [&](const Grip& grip) {
      return grip.hand != nullptr && actor.character.Owns(grip.hand);
    });
    if (own == thing.grips.end()) continue;
    // As currently held; if the current state is not finite, as it was when taken.
    const Eigen::Isometry3d now = PoseOf(own->hand).inverse() * PoseOf(thing.body);
    carried.emplace_back(&thing, now.matrix().allFinite() ? now : own->in_hand);
    // It can follow only one hand: the others are elsewhere now.
    const dJointID kept = own->joint;
    Release(thing, [kept](const Grip& grip) { return grip.joint != kept; });
  }
  actor.Place(posture, floor);
  for (const auto& [thing, in_hand] : carried) {
    SetPoseAtRest(thing->body, PoseOf(thing->grips.front().hand) * in_hand);
  }
}

void World::SetVelocity(int character, const Vector3d& velocity_m_s) {
  Character& moved = impl_->ActorOf(character).character;
  moved.SetVelocity(velocity_m_s);
  for (const auto& [id, thing] : impl_->things) {
    if (std::none_of(thing.grips.begin(), thing.grips.end(), [&moved](const Grip& grip) {
          return grip.hand != nullptr && moved.Owns(grip.hand);
        })) {
      continue;
    }
    dBodySetLinearVel(thing.body, velocity_m_s.x(), velocity_m_s.y(), velocity_m_s.z());
    dBodySetAngularVel(thing.body, 0, 0, 0);
  }
}

void World::Impl::Constrain(Actor& actor, size_t joint, const Anchor& anchor, bool hard) {
  constexpr double kStiffness_n_m = 2e4;  // by hand
  if (!anchor.point_m.allFinite()) throw std::invalid_argument("Constrain: place must be finite");
  actor.soft_constraint.erase(joint);
  actor.hard_constraint.erase(joint);
  if (hard) {
    actor.hard_constraint[joint] =
        std::make_unique<Pin>(ode, actor.character, joint, anchor, kStiffness_n_m);
  } else {
    actor.soft_constraint[joint] = anchor;
  }
}

void World::Constrain(int character, recon::Joint joint, const Vector3d& place_m, bool hard) {
  impl_->Constrain(impl_->ActorOf(character), recon::Index(joint), Anchor{place_m}, hard);
}

void World::ConstrainTo(int character, recon::Joint joint, int object, const Vector3d& point_m,
                        bool hard) {
  const Thing& thing = impl_->things.at(object);
  impl_->Constrain(impl_->ActorOf(character), recon::Index(joint),
                   Anchor{point_m - thing.middle_m, thing.body, object}, hard);
}

void World::Unconstrain(int character, recon::Joint joint) {
  Actor& actor = impl_->ActorOf(character);
  actor.soft_constraint.erase(recon::Index(joint));
  actor.hard_constraint.erase(recon::Index(joint));
}

void World::ApplyImpulse(int character, recon::Joint joint, const Vector3d& impulse_ns) {
  if (!impulse_ns.allFinite()) throw std::invalid_argument("ApplyImpulse: impulse must be finite");
  impl_->ActorOf(character).pushes.emplace_back(recon::Index(joint), impulse_ns);
}

void World::ApplyForce(int character, recon::Joint joint, const Vector3d& force_n) {
  if (!force_n.allFinite()) throw std::invalid_argument("ApplyForce: force must be finite");
  impl_->ActorOf(character).pulls.emplace_back(recon::Index(joint), force_n);
}

CharacterState World::StateOf(int character) const {
  const Actor& actor = impl_->ActorOf(character);
  CharacterState state;
  state.posture = actor.character.posture();
  state.orientation = actor.character.orientation();
  state.orientation[0] = recon::ComputeOrientations(state.posture)[0];
  state.left_foot_pinned = actor.foot_pin[0].pin() != nullptr;
  state.right_foot_pinned = actor.foot_pin[1].pin() != nullptr;
  state.dodging = actor.dodge_left_s > 0.0 || actor.lean_left_s > 0.0;
  state.max_anchor_gap_m = actor.character.MaxAnchorGap();
  state.max_solver_gap_m = actor.max_gap_m;
  state.rescued = actor.rescued;
  state.momentum_kg_m_s = actor.character.Momentum();
  return state;
}

bool World::IsFinite(int character) const { return impl_->ActorOf(character).character.IsFinite(); }
int World::CharacterCount() const { return static_cast<int>(impl_->actors.size()); }
std::vector<int> World::Characters() const {
  std::vector<int> numbers;
  for (const auto& [id, actor] : impl_->actors) numbers.push_back(id);
  return numbers;
}

}  // namespace ossa::physics
