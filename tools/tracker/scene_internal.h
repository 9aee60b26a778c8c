#pragma once
#include <limits>
#include <map>
#include <memory>
#include <set>

#include "tools/tracker/mechanics_internal.h"
#include "tools/tracker/scene.h"

namespace ossa::tracker {

/// The observation of a person in one frame. Unknown joints are not finite.
struct ScenePerson {
  int id = 0;
  recon::Posture seen;
  recon::JointArray<double> trust{};
  std::optional<recon::JointOrientations> orientation{};
};

/// The state of a hand, or another joint that grabs, between frames.
struct HandMemory {
  struct Place {
    double time_s = 0;
    Eigen::Vector3d at_m = Eigen::Vector3d::Zero();
  };
  std::optional<Eigen::Vector3d> made_m;  // of the character in the last frame
  Eigen::Vector3d made_velocity_m_s = Eigen::Vector3d::Zero();
  std::vector<Place> seen;                                      // as tracked, latest last
  Eigen::Vector3d seen_velocity_m_s = Eigen::Vector3d::Zero();  // of the last frame only
  Eigen::Vector3d fastest_m_s = Eigen::Vector3d::Zero();        // of the current swing, as tracked
  double held_at_m = 0.0;  // as tracked, from the surface when it grabbed
  double away_s = 0.0;     // time beyond the release distance
  GrabRule taken_by{};     // the rule by which it grabbed
  bool shares = false;     // other hands hold the object, too, so that it may turn in this one
  double rest_until_s = -std::numeric_limits<double>::infinity();  // grabs nothing before

  void See(double time_s, const Eigen::Vector3d& at_m);
  /// The person was moved to another place; holds are kept.
  void ResetMotion();
  /// The slope of a line fitted through the last positions, robust against a single outlier.
  Eigen::Vector3d SteadyVelocity_m_s() const;
};

/// A person with their character.
struct SceneActor {
  int character = -1;
  int place = 0;  // number in order of appearance, from 1
  CharacterBones bones;
  double came_s = 0.0, seen_s = 0.0;
  int far_frames = 0;
  recon::Posture seen;  // in this frame; unknown joints are the character's
  std::map<recon::Joint, HandMemory> hands;
};

/// A joint that may grab an object, and the rule that applies.
struct SceneHand {
  SceneActor* actor;
  recon::Joint joint{};
  const GrabRule* rule;
};

/// The index of a placed object in the world.
struct ScenePlaced {
  int object = -1;
  double put_s = 0.0;
};

struct Scene::Impl {
  explicit Impl(const SceneOptions& scene_options);

  void Restart();
  void Play(double time_s, const std::optional<Eigen::Vector4d>& floor,
            const std::vector<ScenePerson>& people);

  // scene_people.cpp
  void FollowPeople(const std::vector<ScenePerson>& people, bool gap);
  void Make(SceneActor& actor, const recon::Posture& start);
  bool IsElsewhere(SceneActor& actor, const recon::Posture& seen) const;
  void DeleteGone();
  void WatchHands(double dt_s);
  // scene_objects.cpp
  void FollowFloor(const std::optional<Eigen::Vector4d>& seen, double dt_s);
  std::optional<Eigen::Isometry3d> OriginOf(const SceneObject& object) const;
  void PutObjects();
  /// Whether the object intersects a person.
  bool IntersectsPerson(int object) const;
  void Put(const SceneObject& object, ScenePlaced& placed, const Eigen::Isometry3d& origin);
  void UpdateObjectStates();
  // scene_rules.cpp
  void ApplyRules(double dt_s);
  void Throw(const ThrowRule& rule);
  void Release(const ReleaseRule& rule, double dt_s);
  void Grab(const std::string& name, int object);
  void Take(const std::string& name, int object, const SceneHand& taking);
  void Hold(SceneActor& actor, recon::Joint joint, int object);
  /// Lets an object held by several hands turn in them, and fixes it in a single hand.
  void ShareHolds(int object);
  /// Free hands at an object that satisfy the rule's distance and speed.
  std::vector<SceneHand> HandsAt(const GrabRule& rule, int object);
  void LetGo(const std::string& name, const physics::Holder& holder, SceneEvent::Kind kind);
  void LetAllGo(const std::string& name, SceneEvent::Kind kind);
  /// Existing dynamic objects that a rule names, by name.
  std::vector<std::pair<std::string, int>> Named(const std::vector<std::string>& names) const;
  bool HoldsSomething(int character, recon::Joint joint) const;
  /// The person with this character, by id.
  std::pair<const int, SceneActor>* Owner(int character);

  SceneOptions options;
  physics::World world;
  std::map<int, SceneActor> actors;  // by body id
  std::map<std::string, ScenePlaced> placed;
  std::set<recon::Joint> grabbing;  // joints that grab by any rule
  std::optional<Eigen::Vector4d> floor;
  double floor_since_s = 0.0;
  recon::FrameSteps steps;
  double now_s = 0.0;    // sum of the steps: strictly increasing
  double stamp_s = 0.0;  // timestamp of the latest frame
  bool began = false;
  int came = 0;  // number of people so far
  std::vector<SceneObjectState> objects;
  std::vector<SceneEvent> events;
};

}  // namespace ossa::tracker
