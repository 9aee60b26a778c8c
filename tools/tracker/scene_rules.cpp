// What people do with the objects of a scene: take, carry, let go, throw.
#include <algorithm>
#include <cmath>

#include "tools/tracker/scene_internal.h"

namespace ossa::tracker {
namespace {

using Eigen::Vector3d;
using recon::Joint;

// Constants: chosen by hand.

constexpr double kRest_s = 0.7;        // who let go does not take it again at once
constexpr double kSlowingDown = 0.85;  // share of a swing's fastest speed: it is over

bool IsNamed(const std::vector<std::string>& names, const std::string& name) {
  return names.empty() || std::find(names.begin(), names.end(), name) != names.end();
}

/// A hand that could take hold of an object, or holds it.
struct Hand {
  SceneActor* actor;
  Joint joint;
};

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

double Scene::Impl::StrengthOn(int object) const {
  for (const auto& [name, at] : placed) {
    if (at.object != object) continue;
    for (const GrabRule& grab : options.grabs) {
      if (IsNamed(grab.objects, name)) return grab.strength_n;
    }
  }
  return GrabRule{}.strength_n;
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
  for (const GrabRule& rule : options.grabs) Grab(rule);
}

// The character's hand is behind the one that is seen, and swings what it holds further: what is
// thrown flies as the hand that is seen went at its fastest.
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
      if (hand.seen_velocity_m_s.back().norm() >= kSlowingDown * fastest_m_s) continue;
      if (fastest_m_s > rule.faster_m_s) thrown_m_s = hand.fastest_m_s;
      hand.fastest_m_s = steady_m_s;  // of another swing
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

void Scene::Impl::Grab(const GrabRule& rule) {
  const auto& struck = world.Contacts().struck;
  for (const auto& [name, object] : Named(rule.objects)) {
    const physics::ObjectState state = world.ObjectOf(object);
    const auto holders = world.HoldersOf(object);
    std::set<int> people;
    for (const physics::Holder& holder : holders) people.insert(holder.character);
    std::vector<Hand> able;
    for (auto& [id, actor] : actors) {
      for (const Joint joint : rule.joints) {
        HandMemory& hand = actor.hands[joint];
        if (!hand.made_m || now_s < hand.rest_until_s) continue;
        if (HoldsSomething(actor.character, joint)) continue;
        const bool touches = std::any_of(
            struck.begin(), struck.end(),
            [character = actor.character, taken = object, joint](const physics::Strike& strike) {
              return strike.character == character && strike.object == taken &&
                     strike.bone == recon::Index(joint);
            });
        const Vector3d arm = *hand.made_m - state.position_m;
        const Vector3d there_m_s = state.velocity_m_s + state.angular_velocity_rad_s.cross(arm);
        const bool is_near = touches || world.DistanceTo(object, *hand.made_m) < rule.near_m;
        if (!is_near || (hand.made_velocity_m_s - there_m_s).norm() > rule.slower_m_s) continue;
        able.push_back({&actor, joint});
        people.insert(actor.character);
      }
    }
    const bool enough = holders.size() + able.size() >= static_cast<size_t>(rule.hands) &&
                        people.size() >= static_cast<size_t>(rule.people);
    if (!enough) {
      LetAllGo(name, SceneEvent::Kind::kReleased);  // too few are left to hold it
      continue;
    }
    for (const Hand& one : able) {
      HandMemory& hand = one.actor->hands[one.joint];
      hand.held_at_m = world.DistanceTo(object, one.actor->seen[one.joint]);
      hand.away_s = 0.0;
      hand.fastest_m_s.setZero();
      world.Hold(one.actor->character, one.joint, object, true, rule.strength_n);
      events.push_back(
          {SceneEvent::Kind::kGrabbed, name, Owner(one.actor->character)->first, one.joint});
    }
  }
}

}  // namespace ossa::tracker
