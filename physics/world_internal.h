#pragma once
#include <deque>
#include <map>

#include "physics/actor_internal.h"
#include "physics/world.h"

namespace ossa::physics {

/// A virtual joint between a thing and a hand, or a point of the world.
struct Grip {
  dJointID joint = nullptr;
  dJointID turning = nullptr;  // what keeps one that may turn from it
  uint64_t made = 0;           // OdeWorld::made
  int character = -1;          // none: it hangs
  size_t bone = 0;             // that holds it
  bool rigid = false;
  double strength_n = 0.0;
  double torque_nm = 0.0;   // of a rigid one: beyond, it turns
  Eigen::Vector3d point_m;  // about which it turns, when it was taken
  /// Of one that slips: where it is on the thing now, in the body's frame, and how far off the
  /// surface it was when it was taken.
  std::optional<Eigen::Vector3d> on_thing_m{};
  double taken_off_m = 0.0;
  BodyMemory hand_then, thing_then;            // when it was taken
  dBodyID hand = nullptr, beside = nullptr;    // the bone that holds it, and the one before
  Eigen::Isometry3d in_hand;                   // bone from object, when it was taken
  std::unique_ptr<dJointFeedback> feedback{};  // of one that can break
};

/// A force that lasts for a Step.
struct Load {
  Eigen::Vector3d force_n, torque_nm;
  Eigen::Vector3d at_m;  // in the body's frame
};

/// An object. The body's origin is its centre of mass.
struct Thing {
  ObjectOptions info;
  uint64_t made = 0;  // OdeWorld::made
  dBodyID body = nullptr;
  std::vector<dGeomID> geoms;
  Eigen::Vector3d middle_m = Eigen::Vector3d::Zero();  // centre of mass in the object's frame
  std::vector<Grip> grips{};  // of all that hold it, in the order in which they took it
  Eigen::Isometry3d before = Eigen::Isometry3d::Identity();  // pose when the present Step began
  std::vector<Load> loads{};                                 // of the next Step
  std::optional<Eigen::Isometry3d> goal{};  // of a kinematic one, at the end of the next Step

  bool IsMoved() const { return info.kind == BodyKind::kDynamic; }
};

/// Characters carry the tag index + 1 in their geoms, things -(index + 1), the floor 0.
inline int TagOf(dGeomID geom) {
  return static_cast<int>(reinterpret_cast<intptr_t>(dGeomGetData(geom)));
}
Party PartyOf(dGeomID geom);

/// From a point of the object's frame to its surface, metres; below 0 inside.
double DistanceToObject(const ObjectOptions& object, const Eigen::Vector3d& point_m);

/// Limbs see the floor coming from this much further away than other things: a plane costs nothing,
/// and a foot that jumps to a new target comes down at 15 m/s.
// Derived: 15 m/s for a substep of 1/300 s is 5 cm; twice that
constexpr double kFloorLook_m = 0.1;

struct World::Impl {
  explicit Impl(const WorldOptions& world_options);
  ~Impl();

  class Restorer;  // world_snapshot.cpp
  /// How two things meet.
  struct Surface {
    SoftConstraint soft{};
    double friction = 0.0, bounce = 0.0;
    double margin_m = 0.0;  // by how much their geoms are larger than they
    bool self = false;      // limbs of one character
  };
  /// A contact joint of the present substep.
  struct Pressing {
    Party a, b;
    Eigen::Vector3d position_m, normal;
    double depth_m;
    dJointFeedback feedback;
  };

  Actor& ActorOf(int character) { return *actors.at(character); }
  /// Stands a character still in a posture, with what it holds.
  void Place(Actor& actor, const recon::Posture& posture);
  /// Of the constraint solver, for the characters that are there.
  void SetIterations();
  Actor& MakeActor(int character, const recon::BoneLengths& lengths,
                   const CharacterOptions& character_options);
  Thing& MakeThing(int object, const ObjectOptions& object_options);
  void DestroyThing(Thing& thing);
  /// Joins hand and thing as they are, `grip` saying how.
  void Take(Thing& thing, Grip grip);
  void Connect(const Thing& thing, Grip& grip);
  /// Opens those of its grips that `opens` names.
  static void Release(Thing& thing, const std::function<bool(const Grip&)>& opens);
  static void Release(Thing& thing);
  void ReleaseAllOf(int character);
  void Constrain(Actor& actor, size_t joint, const Anchor& anchor, bool hard);
  void Substep(double left_s, double h_s);
  void RescueLost();
  void BreakHolds();
  void CarryTogether();
  void SlipHolds(double h_s);
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
  dGeomID probe = dCreateSphere(nullptr, 0.1);                  // the end of a capsule
  std::optional<Eigen::Vector4d> floor;
  Eigen::Vector3d gravity_m_s2;
  // Pointers: joints and bodies hold on to their actors' addresses.
  std::map<int, std::unique_ptr<Actor>> actors;
  std::map<int, Thing> things;
  int next_actor = 0, next_thing = 0;
  std::vector<std::pair<dGeomID, dGeomID>> near;  // pairs of the present substep
  std::deque<Pressing> pressing;
  std::map<std::array<int, 4>, Contact> touching;  // of the present Step, by tags and bones
  ContactSummary contacts;
  double step_s = 0.0;  // of the present substep
  uint64_t steps = 0;
};

}  // namespace ossa::physics
