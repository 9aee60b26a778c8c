#pragma once
#include "physics/actor_internal.h"
#include "physics/world.h"

namespace ossa::physics {

struct Thing {
  ObjectOptions info;
  dBodyID body = nullptr;
  dGeomID geom = nullptr;
  dJointID held = nullptr;  // virtual joint to a hand or to the world
  dBodyID hand = nullptr;   // the bone that holds it
  Eigen::Isometry3d in_hand = Eigen::Isometry3d::Identity();  // bone from object, when it was taken
  dBodyID beside = nullptr;  // the bone before the hand that holds it
  Eigen::Isometry3d before = Eigen::Isometry3d::Identity();  // pose when the present Step began
};

/// Characters carry the tag index + 1 in their geoms, things -(index + 1), the floor 0.
inline int TagOf(dGeomID geom) {
  return static_cast<int>(reinterpret_cast<intptr_t>(dGeomGetData(geom)));
}

/// Limbs see the floor coming from this much further away than other things: a plane costs nothing,
/// and a foot that jumps to a new target comes down at 15 m/s.
// Derived: 15 m/s for a substep of 1/300 s is 5 cm; twice that
constexpr double kFloorLook_m = 0.1;

struct World::Impl {
  explicit Impl(const WorldOptions& world_options);
  ~Impl();

  /// How two things meet.
  struct Surface {
    SoftConstraint soft{};
    double friction = 0.0, bounce = 0.0;
    double margin_m = 0.0;  // by how much their geoms are larger than they
    bool self = false;      // limbs of one character
  };

  /// Stands a character still in a posture, with what it holds.
  void Place(Actor& actor, const recon::Posture& posture);
  void Substep(double left_s, double h_s);
  void RescueLost();
  void WatchThreats(double dt_s);
  // contact.cpp
  void Collide(double h_s);
  void CollidePair(dGeomID a, dGeomID b);
  void Touch(dGeomID a, dGeomID b, dContact contact, const Surface& surface, double depth_m);
  void Press(dGeomID a, dGeomID b, dContact contact, double depth_m);
  void CollideFloor();
  int CapsuleEndsOnBox(dGeomID a, dGeomID b, dContact* contact);
  Surface SurfaceOf(int tag_a, int tag_b) const;
  void Note(dGeomID a, dGeomID b, double depth_m);
  static void OnNearPair(void* self, dGeomID a, dGeomID b);

  WorldOptions options;
  OdeWorld ode;
  dGeomID floor_geom = dCreatePlane(nullptr, 0, 1, 0, 0);
  dGeomID limb_floor_geom = dCreatePlane(nullptr, 0, 1, 0, 0);  // kFloorLook_m higher
  dGeomID probe = dCreateSphere(nullptr, 0.1);                  // the end of a capsule
  std::optional<Eigen::Vector4d> floor;
  Eigen::Vector3d gravity_m_s2;
  // Pointers: joints and bodies hold on to their actors' addresses.
  std::vector<std::unique_ptr<Actor>> actors;
  std::vector<Thing> things;
  ContactSummary contacts;
  double step_s = 0.0;  // of the present substep
  uint64_t steps = 0;
};

}  // namespace ossa::physics
