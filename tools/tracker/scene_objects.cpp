// Objects of a scene: floor, placement, reported states.
#include <algorithm>
#include <cmath>

#include "physics/anthropometry.h"
#include "tools/tracker/scene_internal.h"

namespace ossa::tracker {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;
using Eigen::Vector4d;
using recon::Joint;

// Constants: chosen by hand.

constexpr double kSettling_s = 0.3;     // the first detections of floor or person may be off
constexpr double kFloorMemory_s = 1.0;  // time constant: the detected floor jitters

/// A right-handed frame: y up, z along the horizontal part of `ahead`, origin on the floor below
/// `above`.
Isometry3d LevelFrame(const Vector4d& floor, const Vector3d& above, const Vector3d& ahead) {
  const Vector3d up = floor.head<3>();
  Vector3d z = ahead - ahead.dot(up) * up;
  if (z.norm() < 1e-3) z = up.unitOrthogonal();
  z.normalize();
  Isometry3d frame = Isometry3d::Identity();
  frame.linear() << up.cross(z), up, z;
  frame.translation() = above - (floor.dot(above.homogeneous())) * up;
  return frame;
}

}  // namespace

/// Uses the floor of the options; else the first detected one, which is averaged with later ones.
void Scene::Impl::FollowFloor(const std::optional<Vector4d>& seen, double dt_s) {
  const std::optional<Vector4d>& told = options.floor ? options.floor : seen;
  if (told && told->allFinite() && told->head<3>().norm() > 1e-6) {
    const Vector4d unit = *told / told->head<3>().norm();
    if (!floor) floor_since_s = now_s;
    const double share = floor ? 1.0 - std::exp(-dt_s / kFloorMemory_s) : 1.0;
    const Vector4d mixed = floor ? Vector4d(*floor + share * (unit - *floor)) : unit;
    floor = mixed / mixed.head<3>().norm();
  }
  world.SetFloor(floor);
}

/// World from the frame of an object's place; nothing until that is known for long enough.
std::optional<Isometry3d> Scene::Impl::OriginOf(const SceneObject& object) const {
  const double wait_s = kSettling_s + object.after_s;
  if (!floor) return std::nullopt;
  if (object.origin == SceneObject::Origin::kFloor) {
    if (now_s - floor_since_s < wait_s) return std::nullopt;
    return LevelFrame(*floor, Vector3d::Zero(), Vector3d::UnitZ());
  }
  for (const auto& [id, actor] : actors) {
    if (actor.place != object.person || now_s - std::max(actor.came_s, floor_since_s) < wait_s) {
      continue;
    }
    const recon::Posture made = world.StateOf(actor.character).posture;
    const Vector3d left = made[Joint::kHipLeft] - made[Joint::kHipRight] +
                          made[Joint::kShoulderLeft] - made[Joint::kShoulderRight];
    const Vector3d up = floor->head<3>();
    return LevelFrame(*floor, made[Joint::kHipCenter], left.cross(up));
  }
  return std::nullopt;
}

void Scene::Impl::PutObjects() {
  for (const SceneObject& object : options.objects) {
    const auto there = placed.find(object.name);
    if (there != placed.end()) {
      const bool is_due = object.again_s > 0.0 && now_s - there->second.put_s >= object.again_s;
      if (!is_due || !world.HoldersOf(there->second.object).empty()) continue;
    }
    const auto origin = OriginOf(object);
    if (!origin) continue;
    Put(object, placed[object.name], *origin);
    if (there == placed.end() && IntersectsPerson(placed[object.name].object)) {
      world.RemoveObject(placed[object.name].object);  // retried in the next frame
      placed.erase(object.name);
    } else if (there == placed.end()) {
      events.push_back({SceneEvent::Kind::kAppeared, object.name});
    }
  }
}

bool Scene::Impl::IntersectsPerson(int object) const {
  constexpr int kPoints = 5;  // along a bone: the longest, 45 cm, is as thick as they are apart
  for (const auto& [id, actor] : actors) {
    const physics::Segments segments = physics::ComputeSegments(actor.bones.lengths_m(), 0.0, 0.0);
    const recon::Posture made = world.StateOf(actor.character).posture;
    for (size_t j = 1; j < recon::kJointCount; ++j) {
      const Vector3d from = made.position_m[recon::ParentOf(j)];
      for (int k = 0; k < kPoints; ++k) {
        const double share = static_cast<double>(k) / (kPoints - 1);
        const Vector3d at = from + share * (made.position_m[j] - from);
        if (world.DistanceTo(object, at) < segments[j].radius_m) return true;
      }
    }
  }
  return false;
}

void Scene::Impl::Put(const SceneObject& object, ScenePlaced& at, const Isometry3d& origin) {
  const Eigen::Quaterniond turn(origin.linear());
  physics::ObjectOptions body = object.body;
  body.position_m = origin * body.position_m;
  body.orientation = turn * body.orientation;
  body.velocity_m_s = turn * body.velocity_m_s;
  body.angular_velocity_rad_s = turn * body.angular_velocity_rad_s;
  if (at.object < 0) {
    at.object = world.AddObject(body);
  } else {
    world.SetPose(at.object, body.position_m, body.orientation);
    world.SetObjectVelocity(at.object, body.velocity_m_s, body.angular_velocity_rad_s);
  }
  at.put_s = now_s;
}

void Scene::Impl::UpdateObjectStates() {
  objects.clear();
  for (const SceneObject& object : options.objects) {
    const auto there = placed.find(object.name);
    if (there == placed.end()) continue;
    const physics::ObjectState state = world.ObjectOf(there->second.object);
    SceneObjectState& told = objects.emplace_back();
    told.name = object.name;
    told.body = object.body;
    told.position_m = state.position_m;
    told.orientation = state.orientation;
    told.velocity_m_s = state.velocity_m_s;
    std::set<int> ids;
    for (const physics::Holder& holder : world.HoldersOf(there->second.object)) {
      if (const auto* owner = Owner(holder.character)) ids.insert(owner->first);
    }
    told.held_by.assign(ids.begin(), ids.end());
  }
}

}  // namespace ossa::tracker
