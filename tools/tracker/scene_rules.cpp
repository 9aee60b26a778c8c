// Interaction of people with objects: grab, carry, release, throw.
#include <algorithm>
#include <cmath>
#include <limits>

#include "tools/tracker/scene_internal.h"

namespace ossa::tracker {
namespace {

using Eigen::Vector3d;
using recon::Joint;

// Constants: chosen by hand.

constexpr double kRest_s = 0.7;        // pause before the same hand grabs again
constexpr double kSlowingDown = 0.85;  // share of a swing's largest speed below which it has ended

bool IsNamed(const std::vector<std::string>& names, const std::string& name) {
  return names.empty() || std::find(names.begin(), names.end(), name) != names.end();
}

bool IsOf(const GrabRule& rule, Joint joint) {
  return std::find(rule.joints.begin(), rule.joints.end(), joint) != rule.joints.end();
}

/// Whether the hands that hold an object and those that may grab it satisfy the rule.
bool IsEnough(const GrabRule& rule, const std::vector<physics::Holder>& holders,
              const std::vector<SceneHand>& able) {
  std::set<int> people;
  size_t hands = able.size();
  for (const SceneHand& hand : able) people.insert(hand.actor->character);
  for (const physics::Holder& holder : holders) {
    if (!IsOf(rule, holder.joint)) continue;
    people.insert(holder.character);
    ++hands;
  }
  return hands >= static_cast<size_t>(rule.hands) &&
         people.size() >= static_cast<size_t>(rule.people);
}

}  // namespace

std::vector<std::pair<std::string, int>> Scene::Impl::Named(
    const std::vector<std::string>& names) const {
  std::vector<std::pair<std::string, int>> found;
  for (const auto& [name, at] : placed) {
    const bool moves = world.ObjectInfo(at.object).kind == physics::BodyKind::kDynamic;
    if (moves && IsNamed(names, name)) found.emplace_back(name, at.object);
  }
  return found;
}

std::pair<const int, SceneActor>* Scene::Impl::Owner(int character) {
  const auto found = std::find_if(actors.begin(), actors.end(), [&](const auto& entry) {
    return entry.second.character == character;
  });
  return found == actors.end() ? nullptr : &*found;
}

bool Scene::Impl::HoldsSomething(int character, Joint joint) const {
  const physics::Holder hand{character, joint};
  return std::any_of(placed.begin(), placed.end(), [&](const auto& entry) {
    const auto holders = world.HoldersOf(entry.second.object);
    return std::find(holders.begin(), holders.end(), hand) != holders.end();
  });
}

void Scene::Impl::LetGo(const std::string& name, const physics::Holder& holder,
                        SceneEvent::Kind kind) {
  world.Release(placed.at(name).object, holder.character, holder.joint);
  auto* const owner = Owner(holder.character);
  if (owner == nullptr) return;
  owner->second.hands[holder.joint].rest_until_s = now_s + kRest_s;
  events.push_back({kind, name, owner->first, holder.joint});
}

void Scene::Impl::LetAllGo(const std::string& name, SceneEvent::Kind kind) {
  for (const physics::Holder& holder : world.HoldersOf(placed.at(name).object)) {
    LetGo(name, holder, kind);
  }
}

void Scene::Impl::ApplyRules(double dt_s) {
  for (const int torn : world.Contacts().broken) {
    for (const auto& [name, at] : placed) {
      if (at.object == torn) events.push_back({SceneEvent::Kind::kTorn, name});
    }
  }
  for (const ThrowRule& rule : options.throws) Throw(rule);
  for (const ReleaseRule& rule : options.releases) Release(rule, dt_s);
  for (const auto& [name, object] : Named({})) {
    Grab(name, object);
    ShareHolds(object);
  }
}

// Thrown objects get the largest tracked velocity of the hand, because the character's hand lags
// behind and continues the swing.
void Scene::Impl::Throw(const ThrowRule& rule) {
  for (const auto& [name, object] : Named(rule.objects)) {
    std::optional<Vector3d> thrown_m_s;
    for (const physics::Holder& holder : world.HoldersOf(object)) {
      auto* const owner = Owner(holder.character);
      if (owner == nullptr) continue;
      HandMemory& hand = owner->second.hands[holder.joint];
      const Vector3d steady_m_s = hand.SteadyVelocity_m_s();
      if (steady_m_s.norm() > hand.fastest_m_s.norm()) hand.fastest_m_s = steady_m_s;
      const double fastest_m_s = hand.fastest_m_s.norm();
      if (hand.seen_velocity_m_s.norm() >= kSlowingDown * fastest_m_s) continue;
      if (fastest_m_s > rule.faster_m_s) thrown_m_s = hand.fastest_m_s;
      hand.fastest_m_s = steady_m_s;  // the next swing begins
    }
    if (!thrown_m_s) continue;
    LetAllGo(name, SceneEvent::Kind::kThrown);
    world.SetObjectVelocity(object, *thrown_m_s, world.ObjectOf(object).angular_velocity_rad_s);
  }
}

void Scene::Impl::Release(const ReleaseRule& rule, double dt_s) {
  for (const auto& [name, object] : Named(rule.objects)) {
    for (const physics::Holder& holder : world.HoldersOf(object)) {
      auto* const owner = Owner(holder.character);
      if (owner == nullptr) continue;
      HandMemory& hand = owner->second.hands[holder.joint];
      const double off_m = world.DistanceTo(object, owner->second.seen[holder.joint]);
      const bool is_away = off_m - std::max(hand.held_at_m, 0.0) > rule.away_m;
      hand.away_s = is_away ? hand.away_s + dt_s : 0.0;
      if (hand.away_s > rule.for_s) LetGo(name, holder, SceneEvent::Kind::kReleased);
    }
  }
}

std::vector<SceneHand> Scene::Impl::HandsAt(const GrabRule& rule, int object) {
  const auto& struck = world.Contacts().struck;
  const physics::ObjectState state = world.ObjectOf(object);
  std::vector<SceneHand> able;
  for (auto& [id, actor] : actors) {
    for (const Joint joint : rule.joints) {
      HandMemory& hand = actor.hands[joint];
      if (!hand.made_m || now_s < hand.rest_until_s) continue;
      if (HoldsSomething(actor.character, joint)) continue;
      const bool touches =
          std::any_of(struck.begin(), struck.end(),
                      [character = actor.character, object, joint](const physics::Strike& strike) {
                        return strike.character == character && strike.object == object &&
                               strike.bone == recon::Index(joint);
                      });
      const Vector3d arm = *hand.made_m - state.position_m;
      const Vector3d there_m_s = state.velocity_m_s + state.angular_velocity_rad_s.cross(arm);
      const bool is_near = touches || world.DistanceTo(object, *hand.made_m) < rule.near_m;
      if (!is_near || (hand.made_velocity_m_s - there_m_s).norm() > rule.slower_m_s) continue;
      able.push_back({&actor, joint, &rule});
    }
  }
  return able;
}

// Several rules may apply to one object: it is held as long as one of them is satisfied.
void Scene::Impl::Grab(const std::string& name, int object) {
  const auto holders = world.HoldersOf(object);
  std::vector<SceneHand> taking;
  bool is_ruled = false, is_held = false;
  for (const GrabRule& rule : options.grabs) {
    if (!IsNamed(rule.objects, name)) continue;
    is_ruled = true;
    const std::vector<SceneHand> able = HandsAt(rule, object);
    if (!IsEnough(rule, holders, able)) continue;
    is_held = true;
    taking.insert(taking.end(), able.begin(), able.end());
  }
  if (!is_ruled) return;
  if (!is_held) LetAllGo(name, SceneEvent::Kind::kReleased);  // too few hands are left
  for (const SceneHand& hand : taking) {
    if (!HoldsSomething(hand.actor->character, hand.joint)) Take(name, object, hand);
  }
}

void Scene::Impl::Take(const std::string& name, int object, const SceneHand& taking) {
  HandMemory& hand = taking.actor->hands[taking.joint];
  hand.held_at_m = world.DistanceTo(object, taking.actor->seen[taking.joint]);
  hand.away_s = 0.0;
  hand.fastest_m_s.setZero();
  hand.taken_by = *taking.rule;
  hand.shares = false;
  Hold(*taking.actor, taking.joint, object);
  events.push_back(
      {SceneEvent::Kind::kGrabbed, name, Owner(taking.actor->character)->first, taking.joint});
}

void Scene::Impl::Hold(SceneActor& actor, Joint joint, int object) {
  const HandMemory& hand = actor.hands[joint];
  const double torque_nm =
      hand.shares ? hand.taken_by.shared_torque_nm : std::numeric_limits<double>::infinity();
  world.Hold(actor.character, joint, object, true, hand.taken_by.strength_n, torque_nm);
}

void Scene::Impl::ShareHolds(int object) {
  const auto holders = world.HoldersOf(object);
  const bool shares = holders.size() > 1;
  for (const physics::Holder& holder : holders) {
    auto* const owner = Owner(holder.character);
    if (owner == nullptr) continue;
    HandMemory& hand = owner->second.hands[holder.joint];
    if (hand.shares == shares) continue;
    hand.shares = shares;
    Hold(owner->second, holder.joint, object);
  }
}

}  // namespace ossa::tracker
