// People of a scene: their characters, targets and hands.
#include <algorithm>
#include <cmath>

#include "tools/tracker/scene_internal.h"

namespace ossa::tracker {
namespace {

using Eigen::Vector3d;
using recon::Joint;
using recon::kJointCount;
using recon::Posture;

// Constants: chosen by hand unless stated otherwise.

constexpr double kForget_s = 0.5;  // longest time out of view
constexpr double kElsewhere_m =
    1.0;  // mean of the joints; physics::CharacterFilterOptions::teleport_m
constexpr int kElsewhereFrames = 3;  // and its teleport_frames

physics::CharacterOptions BuildOf(const SceneOptions& scene) {
  physics::CharacterOptions options;
  if (scene.people.motors) options.control = physics::Control::kMotor;
  options.hinges = scene.people.hinges;
  options.joint_limits = scene.people.joint_limits;
  options.gains.rate_rad_s = kFollowing_rad_s;
  options.lead = 1.0;  // as physics::CharacterFilterOptions
  if (scene.dodge) {
    options.dodge = scene.dodge->cover;
    options.lean = scene.dodge->lean;
  }
  return options;
}

/// Completes unknown joints as if the person stood upright. Nothing if no joint is known.
std::optional<Posture> Completed(const Posture& seen, const recon::BoneLengths& lengths_m,
                                 const Vector3d& up) {
  Posture whole = seen;
  const auto known = [&](size_t j) { return seen.position_m[j].allFinite(); };
  if (!known(0)) {
    const auto first = std::find_if(seen.position_m.begin(), seen.position_m.end(),
                                    [](const Vector3d& p) { return p.allFinite(); });
    if (first == seen.position_m.end()) return std::nullopt;
    double height_m = 0.0;  // height of that joint above the hips, standing
    for (size_t j = static_cast<size_t>(first - seen.position_m.begin()); j != 0;
         j = recon::ParentOf(j)) {
      height_m += j < recon::Index(Joint::kHipLeft) ? lengths_m[j] : -lengths_m[j];
    }
    whole.position_m[0] = *first - height_m * up;
  }
  for (size_t j = 1; j < kJointCount; ++j) {
    if (known(j)) continue;
    const double side = j <= recon::Index(Joint::kHead) ? 1.0 : -1.0;  // trunk up, limbs down
    whole.position_m[j] = whole.position_m[recon::ParentOf(j)] + side * lengths_m[j] * up;
  }
  return whole;
}

}  // namespace

/// Creates the character, or replaces it after a change of bone lengths; holds are kept.
void Scene::Impl::Make(SceneActor& actor, const Posture& start) {
  struct Held {
    int object;
    Joint joint;
  };
  std::vector<Held> held;
  if (actor.character >= 0) {
    for (const int object : world.Objects()) {
      for (const physics::Holder& holder : world.HoldersOf(object)) {
        if (holder.character == actor.character) held.push_back({object, holder.joint});
      }
    }
    world.RemoveCharacter(actor.character);
  }
  actor.character = world.AddCharacter(actor.bones.lengths_m(), start, BuildOf(options));
  for (const Held& one : held) {
    Hold(actor, one.joint, one.object);
  }
}

/// Whether a person has been far from their character for several frames.
bool Scene::Impl::IsElsewhere(SceneActor& actor, const Posture& seen) const {
  const bool far =
      recon::MeanDistance_m(world.StateOf(actor.character).posture, seen) > kElsewhere_m;
  actor.far_frames = far ? actor.far_frames + 1 : 0;
  return actor.far_frames >= kElsewhereFrames;
}

void Scene::Impl::FollowPeople(const std::vector<ScenePerson>& people, bool gap) {
  const Vector3d up = floor ? Vector3d(floor->head<3>()) : Vector3d::UnitY();
  for (const ScenePerson& person : people) {
    const bool is_new = !actors.contains(person.id);
    SceneActor& actor = actors[person.id];
    const bool is_to_be_made = actor.bones.Update(person.seen);
    const auto whole = Completed(person.seen, actor.bones.lengths_m(), up);
    if (!whole) {
      if (is_new) actors.erase(person.id);
      continue;
    }
    if (is_new) {
      actor.place = ++came;
      actor.came_s = now_s;
    }
    actor.seen_s = now_s;
    if (is_new || is_to_be_made) {
      Make(actor, is_new ? *whole : world.StateOf(actor.character).posture);
    } else if (gap || IsElsewhere(actor, person.seen)) {
      world.Place(actor.character,
                  recon::FilledFrom(world.StateOf(actor.character).posture, person.seen),
                  person.orientation);
      actor.far_frames = 0;
      for (auto& [joint, hand] : actor.hands) hand.ResetMotion();
    }
    recon::JointArray<double> trust = person.trust;
    for (size_t j = 0; j < kJointCount; ++j) {
      trust[j] = person.seen.position_m[j].allFinite() ? HeldTrust(trust[j]) : 0.0;
    }
    world.SetTarget(actor.character, person.seen, trust, person.orientation);
    actor.seen = recon::FilledFrom(world.StateOf(actor.character).posture, person.seen);
  }
  DeleteGone();
}

void Scene::Impl::DeleteGone() {
  std::erase_if(actors, [this](const auto& entry) {
    if (now_s - entry.second.seen_s <= kForget_s) return false;
    world.RemoveCharacter(entry.second.character);
    return true;
  });
}

void HandMemory::See(double time_s, const Vector3d& at_m) {
  constexpr size_t kPlaces = 4;  // 0.1 s at 30 Hz: a swing of 0.3 s is 4 % faster at its fastest
  if (!seen.empty()) seen_velocity_m_s = (at_m - seen.back().at_m) / (time_s - seen.back().time_s);
  if (seen.size() == kPlaces) seen.erase(seen.begin());
  seen.push_back({time_s, at_m});
}

void HandMemory::ResetMotion() {
  made_m.reset();
  seen.clear();
  for (Vector3d* velocity : {&made_velocity_m_s, &seen_velocity_m_s, &fastest_m_s}) {
    velocity->setZero();
  }
  away_s = 0.0;
}

Vector3d HandMemory::SteadyVelocity_m_s() const {
  constexpr size_t kFewest = 3;  // with two an outlier would not show
  if (seen.size() < kFewest) return Vector3d::Zero();
  const auto count = static_cast<double>(seen.size());
  double middle_s = 0.0, spread_s2 = 0.0;
  for (const Place& place : seen) middle_s += place.time_s / count;
  Vector3d sum = Vector3d::Zero();
  for (const Place& place : seen) {
    const double from_middle_s = place.time_s - middle_s;
    sum += from_middle_s * place.at_m;
    spread_s2 += from_middle_s * from_middle_s;
  }
  return sum / spread_s2;
}

void Scene::Impl::WatchHands(double dt_s) {
  for (auto& [id, actor] : actors) {
    const Posture made = world.StateOf(actor.character).posture;
    for (const Joint joint : grabbing) {
      HandMemory& hand = actor.hands[joint];
      if (hand.made_m) hand.made_velocity_m_s = (made[joint] - *hand.made_m) / dt_s;
      hand.made_m = made[joint];
      hand.See(now_s, actor.seen[joint]);
    }
  }
}

}  // namespace ossa::tracker
