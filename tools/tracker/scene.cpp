#include "tools/tracker/scene.h"

#include <algorithm>
#include <limits>
#include <set>
#include <stdexcept>
#include <utility>

#include "tools/tracker/scene_internal.h"
#include "tools/tracker/tracker.h"

namespace ossa::tracker {
namespace {

using recon::kJointCount;

constexpr double kFrame_s = 1.0 / 30.0;  // 30 Hz, a Kinect SDK's rate
constexpr double kLongestStep_s = 0.25;  // by hand: after a longer gap people are elsewhere

[[noreturn]] void Refuse(const std::string& what, double found, const std::string& range) {
  throw std::invalid_argument(what + " = " + std::to_string(found) + ", must be " + range);
}

void RequirePositive(const std::string& what, double found) {
  if (!(found > 0.0 && found < 1e6)) Refuse(what, found, "in (0, 1e6)");
}

ScenePerson SeenOf(const Body& body) {
  ScenePerson person;
  person.id = body.id;
  person.seen = ToPosture(body);
  recon::JointOrientations turns;
  for (size_t j = 0; j < kJointCount; ++j) {
    person.trust[j] = body.joints[j].reliability;
    turns[j] = body.joints[j].orientation;
  }
  person.orientation = turns;
  return person;
}

ScenePerson SeenOf(const recon::BodyRecord& body) {
  ScenePerson person;
  person.id = body.id;
  recon::JointOrientations turns;
  bool all_turned = true;
  for (size_t j = 0; j < kJointCount; ++j) {
    const auto& joint = body.joints[j];
    const bool known = joint && recon::HasPlace(*joint);
    person.seen.position_m[j] =
        known ? joint->position_m
              : Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN());
    person.trust[j] = known ? joint->reliability.value_or(1.0) : 0.0;
    all_turned &= known && joint->orientation.has_value();
    if (all_turned) turns[j] = *joint->orientation;
  }
  if (all_turned) person.orientation = turns;
  return person;
}

}  // namespace

void SceneOptions::Check() const {
  world.Check();
  std::set<std::string> names;
  for (const SceneObject& object : objects) {
    object.body.Check();
    if (!names.insert(object.name).second) {
      throw std::invalid_argument("objects.name = " + object.name + ", must be used once");
    }
    if (object.person < 1) Refuse("objects.person", object.person, "1 or more");
    if (!(object.after_s >= 0.0)) Refuse("objects.after_s", object.after_s, "0 or more");
    if (!(object.again_s >= 0.0)) Refuse("objects.again_s", object.again_s, "0 or more");
  }
  for (const GrabRule& grab : grabs) {
    RequirePositive("grabs.near_m", grab.near_m);
    RequirePositive("grabs.slower_m_s", grab.slower_m_s);
    RequirePositive("grabs.strength_n", grab.strength_n);
    RequirePositive("grabs.shared_torque_nm", grab.shared_torque_nm);
    if (grab.hands < 1) Refuse("grabs.hands", grab.hands, "1 or more");
    if (grab.people < 1) Refuse("grabs.people", grab.people, "1 or more");
  }
  for (const ReleaseRule& release : releases) {
    RequirePositive("releases.away_m", release.away_m);
    if (!(release.for_s >= 0.0)) Refuse("releases.for_s", release.for_s, "0 or more");
  }
  if (floor && !(floor->allFinite() && floor->head<3>().norm() > 1e-6)) {
    throw std::invalid_argument("floor = a plane without a normal, must be a b c d, all finite");
  }
  for (const ThrowRule& toss : throws) RequirePositive("throws.faster_m_s", toss.faster_m_s);
}

Scene::Impl::Impl(const SceneOptions& scene_options)
    : options(scene_options), world(scene_options.world) {
  for (const GrabRule& grab : options.grabs) {
    grabbing.insert(grab.joints.begin(), grab.joints.end());
  }
}

void Scene::Impl::Restart() {
  world = physics::World(options.world);
  actors.clear();
  placed.clear();
  floor.reset();
  objects.clear();
  events.clear();
  began = false;
  steps = {};
  now_s = 0.0;
  came = 0;
}

void Scene::Impl::Play(double time_s, const std::optional<Eigen::Vector4d>& seen_floor,
                       const std::vector<ScenePerson>& people) {
  if (began && time_s < stamp_s - recon::FrameSteps::kJitter_s) Restart();
  const std::optional<double> step_s = steps.To(time_s);
  const bool gap = !step_s || *step_s > kLongestStep_s;
  const double passed_s = step_s ? *step_s : began ? time_s - stamp_s : kFrame_s;
  now_s += passed_s;
  stamp_s = began ? std::max(stamp_s, time_s) : time_s;
  began = true;
  events.clear();
  FollowFloor(seen_floor, passed_s);
  FollowPeople(people, gap);
  PutObjects();
  const double dt_s = gap ? kFrame_s : passed_s;
  world.Step(dt_s);
  WatchHands(dt_s);
  ApplyRules(dt_s);
  UpdateObjectStates();
}

Scene::Scene(const SceneOptions& options) {
  options.Check();
  impl_ = std::make_unique<Impl>(options);
}
Scene::~Scene() = default;
Scene::Scene(Scene&&) noexcept = default;
Scene& Scene::operator=(Scene&&) noexcept = default;

void Scene::Play(BodyFrame& frame) {
  std::vector<ScenePerson> people;
  for (const Body& body : frame.bodies) {
    if (body.state == BodyState::kTracked) people.push_back(SeenOf(body));
  }
  impl_->Play(frame.time_s, frame.floor, people);
  for (Body& body : frame.bodies) {
    const auto character = CharacterOf(body.id);
    if (!character || body.state != BodyState::kTracked) continue;
    const physics::CharacterState state = impl_->world.StateOf(*character);
    for (size_t j = 0; j < kJointCount; ++j) {
      body.joints[j].position_m = state.posture.position_m[j];
      body.joints[j].orientation = state.orientation[j];
    }
  }
  frame.objects = impl_->objects;
}

void Scene::Play(recon::SkeletonFrame& frame) {
  std::vector<ScenePerson> people;
  for (const recon::BodyRecord& body : frame.bodies) people.push_back(SeenOf(body));
  impl_->Play(frame.time_s, frame.floor, people);
  for (recon::BodyRecord& body : frame.bodies) {
    const auto character = CharacterOf(body.id);
    if (!character) continue;
    const physics::CharacterState state = impl_->world.StateOf(*character);
    SetJoints(state.posture, state.orientation, body);
  }
  frame.objects = ToRecords(impl_->objects);
}

std::vector<recon::ObjectRecord> ToRecords(const std::vector<SceneObjectState>& objects) {
  std::vector<recon::ObjectRecord> records;
  for (const SceneObjectState& object : objects) {
    records.push_back({object.name, object.position_m, object.orientation});
  }
  return records;
}

void Scene::Reset() { impl_->Restart(); }
const std::vector<SceneObjectState>& Scene::objects() const { return impl_->objects; }
const std::vector<SceneEvent>& Scene::events() const { return impl_->events; }
bool Scene::has_floor() const { return impl_->floor.has_value(); }
physics::World& Scene::world() { return impl_->world; }

std::optional<int> Scene::CharacterOf(int body) const {
  const auto found = impl_->actors.find(body);
  if (found == impl_->actors.end()) return std::nullopt;
  return found->second.character;
}

std::optional<int> Scene::ObjectNamed(const std::string& name) const {
  const auto found = impl_->placed.find(name);
  if (found == impl_->placed.end()) return std::nullopt;
  return found->second.object;
}

}  // namespace ossa::tracker
