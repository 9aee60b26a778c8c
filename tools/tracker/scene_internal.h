#pragma once
#include <map>
#include <memory>
#include <set>

#include "tools/tracker/mechanics_internal.h"
#include "tools/tracker/scene.h"

namespace ossa::tracker {

/// A person as they are seen at one moment. Joints that are not known are not finite.
struct ScenePerson {
  int id = 0;
  recon::Posture seen;
  recon::JointArray<double> trust{};
  std::optional<recon::JointOrientations> orientation{};
};

/// A hand, or another joint that takes hold, from moment to moment.
struct HandMemory {
  struct Place {
    double time_s;
    Eigen::Vector3d at_m;
  };
  std::optional<Eigen::Vector3d> made_m;  // of the character at the last moment
  Eigen::Vector3d made_velocity_m_s = Eigen::Vector3d::Zero();
  std::vector<Place> seen;                                      // as tracked, the latest last
  Eigen::Vector3d seen_velocity_m_s = Eigen::Vector3d::Zero();  // of the last step alone
  Eigen::Vector3d fastest_m_s = Eigen::Vector3d::Zero();        // of the present swing, as seen
  double held_at_m = 0.0;      // from the surface when it took hold, as seen
  double away_s = 0.0;         // for how long it has been further away
  GrabRule taken_by{};         // the rule by which it took hold
  bool shares = false;         // others hold it, too: it may turn in this hand
  double rest_until_s = -1e9;  // takes nothing before

  void See(double time_s, const Eigen::Vector3d& at_m);
  /// Somebody was put elsewhere: what it holds it still holds, as it took it.
  void ForgetMotion();
  /// Of the straight line through the last places: an odd one says little.
  Eigen::Vector3d SteadyVelocity_m_s() const;
};

/// A person in the world.
struct SceneActor {
  int character = -1;
  int place = 0;  // the how-manieth that came, from 1
  CharacterBones bones;
  double came_s = 0.0, seen_s = 0.0;
  int far_frames = 0;
  recon::Posture seen;  // at this moment; what is not known is where the character has it
  std::map<recon::Joint, HandMemory> hands;
};

/// A joint of somebody that could take hold, and by which rule it would.
struct SceneHand {
  SceneActor* actor;
  recon::Joint joint;
  const GrabRule* rule;
};

/// An object of the options, and the world's, while it is there.
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
  void ForgetGone();
  void WatchHands(double dt_s);
  // scene_objects.cpp
  void FollowFloor(const std::optional<Eigen::Vector4d>& seen, double dt_s);
  std::optional<Eigen::Isometry3d> OriginOf(const SceneObject& object) const;
  void PutObjects();
  /// Whether somebody is where the object is.
  bool IsInSomebody(int object) const;
  void Put(const SceneObject& object, ScenePlaced& placed, const Eigen::Isometry3d& origin);
  void TellObjects();
  // scene_rules.cpp
  void ApplyRules(double dt_s);
  void Throw(const ThrowRule& rule);
  void Release(const ReleaseRule& rule, double dt_s);
  void Grab(const std::string& name, int object);
  void Take(const std::string& name, int object, const SceneHand& taking);
  void Hold(SceneActor& actor, recon::Joint joint, int object);
  /// Hands that hold it with others let it turn, who holds it alone does not.
  void ShareHolds(int object);
  /// Free hands that are at an object as the rule wants it.
  std::vector<SceneHand> HandsAt(const GrabRule& rule, int object);
  void LetGo(const std::string& name, const physics::Holder& holder, SceneEvent::Kind kind);
  void LetAllGo(const std::string& name, SceneEvent::Kind kind);
  /// Objects that a rule names and that are there, by name.
  std::vector<std::pair<std::string, int>> Named(const std::vector<std::string>& names) const;
  bool HoldsSomething(int character, recon::Joint joint) const;
  /// The person whose character that is, by id.
  std::pair<const int, SceneActor>* Owner(int character);

  SceneOptions options;
  physics::World world;
  std::map<int, SceneActor> actors;  // by body id
  std::map<std::string, ScenePlaced> placed;
  std::set<recon::Joint> grabbing;  // joints that take hold by any rule
  std::optional<Eigen::Vector4d> floor;
  double floor_since_s = 0.0;
  recon::FrameSteps steps;
  double now_s = 0.0;    // by the steps: never stands still
  double stamp_s = 0.0;  // of the latest frame
  bool began = false;
  int came = 0;  // people until now
  std::vector<SceneObjectState> objects;
  std::vector<SceneEvent> events;
};

}  // namespace ossa::tracker
