#pragma once
#include <deque>
#include <map>

#include "physics/actor_internal.h"
#include "physics/world.h"

namespace ossa::physics {

/// A joint between an object and a hand, or a fixed point of the world.
struct Grip {
  dJointID joint = nullptr;
  dJointID turning = nullptr;  // rotational friction, if it may rotate
  uint64_t made = 0;           // OdeWorld::made
  int character = -1;          // -1: attached to the world
  size_t bone = 0;             // bone that holds it
  bool rigid = false;
  double strength_n = 0.0;
  double torque_nm = 0.0;                             // of a rigid grip: slips beyond
  Eigen::Vector3d point_m = Eigen::Vector3d::Zero();  // pivot, when it was taken
  /// For a slipping grip: its current point on the object, in the body's frame, and its distance
  /// from the surface when it was taken.
  std::optional<Eigen::Vector3d> on_thing_m{};
  double taken_off_m = 0.0;
  BodyMemory hand_then, thing_then;          // state when it was taken
  dBodyID hand = nullptr, beside = nullptr;  // the bone that holds it, and its parent
  Eigen::Isometry3d in_hand = Eigen::Isometry3d::Identity();  // bone from object, when taken
  std::unique_ptr<dJointFeedback> feedback{};                 // for grips that can break
};

/// A force applied during one Step.
struct Load {
  Eigen::Vector3d force_n = Eigen::Vector3d::Zero(), torque_nm = Eigen::Vector3d::Zero();
  Eigen::Vector3d at_m = Eigen::Vector3d::Zero();  // in the body's frame
};

/// An object. The body's origin is its centre of mass.
struct Thing {
  ObjectOptions info;
  uint64_t made = 0;  // OdeWorld::made
  dBodyID body = nullptr;
  std::vector<dGeomID> geoms;
  Eigen::Vector3d middle_m = Eigen::Vector3d::Zero();  // centre of mass, object frame
  std::vector<Grip> grips{};                           // all grips on it, in order of creation
  Eigen::Isometry3d before = Eigen::Isometry3d::Identity();  // pose when the Step began
  std::vector<Load> loads{};                                 // for the next Step
  std::optional<Eigen::Isometry3d> goal{};  // target of a kinematic object for the next Step

  bool IsMoved() const { return info.kind == BodyKind::kDynamic; }
};

/// Geoms of characters have the tag index + 1, of objects -(index + 1), of the floor 0.
inline int TagOf(dGeomID geom) {
  return static_cast<int>(reinterpret_cast<intptr_t>(dGeomGetData(geom)));
}
Party PartyOf(dGeomID geom);

/// Signed distance from a point in the object's frame to its surface, metres; negative inside.
double DistanceToObject(const ObjectOptions& object, const Eigen::Vector3d& point_m);

/// Distance at which limbs detect the floor, larger than for other objects: a plane is cheap, and a
/// foot whose target jumps comes down at 15 m/s.
// Derived: 15 m/s for a substep of 1/300 s is 5 cm; twice that
constexpr double kFloorLook_m = 0.1;

struct World::Impl {
  explicit Impl(const WorldOptions& world_options);
  ~Impl();

  class Restorer;  // world_snapshot.cpp
  /// Contact properties of two geoms.
  struct Surface {
    SoftConstraint soft{};
    double friction = 0.0, bounce = 0.0;
    double margin_m = 0.0;  // margin of their geoms
    bool self = false;      // both are limbs of one character
  };
  /// A contact joint of the current substep.
  struct Pressing {
    Party a, b;
    Eigen::Vector3d position_m = Eigen::Vector3d::Zero(), normal = Eigen::Vector3d::Zero();
    double depth_m = 0;
    dJointFeedback feedback;
  };

  Actor& ActorOf(int character) { return *actors.at(character); }
  /// Places a character at rest in a posture, with the objects it holds.
  void Place(Actor& actor, const recon::Posture& posture);
  /// Sets the solver iterations for the current characters.
  void SetIterations();
  Actor& MakeActor(int character, const recon::BoneLengths& lengths,
                   const CharacterOptions& character_options);
  Thing& MakeThing(int object, const ObjectOptions& object_options);
  void DestroyThing(Thing& thing);
  /// Joins hand and object in their current poses, as described by `grip`.
  void Take(Thing& thing, Grip grip);
  void Connect(const Thing& thing, Grip& grip);
  /// Releases the grips selected by `opens`.
  static void Release(Thing& thing, const std::function<bool(const Grip&)>& opens);
  static void Release(Thing& thing);
  void ReleaseAllOf(int character);
  void Constrain(Actor& actor, size_t joint, const Anchor& anchor, bool hard);
  void Substep(double left_s, double h_s);
  void RescueLost();
  void BreakHolds();
  void ShareCarriedWeight();
  void SlipGrips(double h_s);
  void WatchThreats(double dt_s);
  void WatchForThings(Actor& actor) const;
  double FastestThing_m_s() const;
  void MoveKinematic(double dt_s);
  void FinishStep(const std::vector<Contact>& before);
  // contact.cpp
  void Collide(double h_s);
  void CollidePair(dGeomID a, dGeomID b);
  void Touch(dGeomID a, dGeomID b, dContact contact, const Surface& surface, double depth_m);
  void Press(dGeomID a, dGeomID b, dContact contact, double depth_m);
  void Join(dGeomID a, dGeomID b, const dContact& contact, double depth_m);
  void CollideFloor();
  void CollideNear();
  bool MayMeet(dGeomID a, dGeomID b) const;
  int CapsuleEndsOnBox(dGeomID a, dGeomID b, dContact* contact);
  Surface SurfaceOf(int tag_a, int tag_b) const;
  // contact_report.cpp
  void Note(dGeomID a, dGeomID b, double depth_m);
  void GatherImpulses(double h_s);

  WorldOptions options;
  WorldCallbacks callbacks;
  OdeWorld ode;
  dGeomID floor_geom = dCreatePlane(nullptr, 0, 1, 0, 0);
  dGeomID limb_floor_geom = dCreatePlane(nullptr, 0, 1, 0, 0);  // kFloorLook_m higher
  dGeomID probe = dCreateSphere(nullptr, 0.1);                  // stands for the end of a capsule
  std::optional<Eigen::Vector4d> floor;
  Eigen::Vector3d gravity_m_s2 = Eigen::Vector3d::Zero();
  // Pointers, because joints and bodies store the addresses of their actors.
  std::map<int, std::unique_ptr<Actor>> actors;
  std::map<int, Thing> things;
  int next_actor = 0, next_thing = 0;
  std::vector<std::pair<dGeomID, dGeomID>> near;  // colliding pairs of the current substep
  std::deque<Pressing> pressing;
  std::map<std::array<int, 4>, Contact> touching;  // in the current Step, by tags and bones
  ContactSummary contacts;
  double step_s = 0.0;  // duration of the current substep
  uint64_t steps = 0;
};

}  // namespace ossa::physics
