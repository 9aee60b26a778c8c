#pragma once
#include <ode/ode.h>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cstdint>

namespace ossa::physics {

static_assert(sizeof(dReal) == sizeof(double), "Debian's ODE is built for double precision");

inline Eigen::Vector3d ToEigen(const dReal* v) { return {v[0], v[1], v[2]}; }
/// ODE's quaternions are w x y z, like ours in files; Eigen's constructor takes that order.
inline Eigen::Quaterniond QuaternionToEigen(const dReal* q) { return {q[0], q[1], q[2], q[3]}; }
inline void SetRotation(dBodyID body, const Eigen::Quaterniond& q) {
  const dQuaternion quaternion = {q.w(), q.x(), q.y(), q.z()};
  dBodySetQuaternion(body, quaternion);
}

inline Eigen::Isometry3d PoseOf(dBodyID body) {
  Eigen::Isometry3d pose(QuaternionToEigen(dBodyGetQuaternion(body)));
  pose.pretranslate(ToEigen(dBodyGetPosition(body)));
  return pose;
}
/// Whether a body's motion is finite and within 10 km of the origin. Collision detection works up
/// to about 1e8 m.
inline bool IsFiniteAndNear(dBodyID body) {
  // By hand: farther than any room, near enough for micrometre precision
  constexpr double kFarthest_m = 1e4;
  const Eigen::Quaterniond q = QuaternionToEigen(dBodyGetQuaternion(body));
  const Eigen::Vector3d p = ToEigen(dBodyGetPosition(body));
  return p.allFinite() && p.norm() <= kFarthest_m && q.coeffs().allFinite() &&
         ToEigen(dBodyGetLinearVel(body)).allFinite() &&
         ToEigen(dBodyGetAngularVel(body)).allFinite();
}
/// Sets a body's pose, at rest.
inline void SetPoseAtRest(dBodyID body, const Eigen::Isometry3d& pose) {
  const Eigen::Vector3d at = pose.translation();
  dBodySetPosition(body, at.x(), at.y(), at.z());
  SetRotation(body, Eigen::Quaterniond(pose.linear()));
  dBodySetLinearVel(body, 0, 0, 0);
  dBodySetAngularVel(body, 0, 0, 0);
  dBodySetForce(body, 0, 0, 0);
  dBodySetTorque(body, 0, 0, 0);
}

/// A body's exact state.
struct BodyMemory {
  std::array<dReal, 3> position{}, velocity{}, turning{};
  std::array<dReal, 4> quaternion{};
  std::array<dReal, 12> rotation{};
};
BodyMemory Remember(dBodyID body);
void Recall(dBodyID body, const BodyMemory& memory);

/// A point of the world or of a moving body.
struct Anchor {
  Eigen::Vector3d point_m = Eigen::Vector3d::Zero();  // in the world, or in the body's frame
  dBodyID body = nullptr;
  int object = -1;  // object of that body
  Eigen::Vector3d Now() const { return body == nullptr ? point_m : PoseOf(body) * point_m; }
};

/// Initialises ODE: once per process, and once per thread. ODE stays initialised for the life of
/// the process.
void PrepareOde();

/// dWorldQuickStep with a row order that depends on `seed` only. ODE shuffles its rows with a
/// process-wide generator, so steps of several threads are serialised.
void SeededQuickStep(dWorldID world, double h_s, uint64_t seed);

/// An ODE world, its collision space and its contact joints.
class OdeWorld {
 public:
  OdeWorld();
  ~OdeWorld();
  OdeWorld(const OdeWorld&) = delete;
  OdeWorld& operator=(const OdeWorld&) = delete;

  dWorldID world;
  dSpaceID space;          // everything that bodies may collide with
  dJointGroupID contacts;  // contacts of the current step
  /// Creation counter: snapshots are restored in the same order, which the solver's rows depend on.
  uint64_t made = 0;
};

/// Stiffness and damping as ODE's error reduction (ERP) and constraint force mixing (CFM) for a
/// step of h (ODE manual, "How to use ERP and CFM"): an implicit, hence unconditionally stable,
/// spring.
struct SoftConstraint {
  double erp = 0, cfm = 0;
};
inline SoftConstraint SpringDamper(double stiffness_n_m, double damping_ns_m, double h_s) {
  const double hk = h_s * stiffness_n_m;
  return {hk / (hk + damping_ns_m), 1.0 / (hk + damping_ns_m)};
}

}  // namespace ossa::physics
