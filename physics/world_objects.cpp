// The objects of a world.
#include <cmath>
#include <stdexcept>
#include <string>

#include "physics/world_internal.h"

namespace ossa::physics {
namespace {

using Eigen::Isometry3d;
using Eigen::Quaterniond;
using Eigen::Vector3d;

double VolumeOf(Shape shape, const Vector3d& s) {
  const double area = 0.25 * M_PI * s.x() * s.x();
  if (shape == Shape::kBall) return area * s.x() * 2.0 / 3.0;
  if (shape == Shape::kCapsule) return area * (s.y() + s.x() * 2.0 / 3.0);
  return s.prod();
}

dGeomID MakeGeom(dSpaceID space, Shape shape, const Vector3d& s) {
  if (shape == Shape::kBall) return dCreateSphere(space, 0.5 * s.x());
  if (shape == Shape::kCapsule) return dCreateCapsule(space, 0.5 * s.x(), s.y());
  return dCreateBox(space, s.x(), s.y(), s.z());
}

/// `axis` of a capsule: 2 is y, 3 is z.
void SetMass(Shape shape, const Vector3d& s, double mass_kg, int axis, dMass& mass) {
  if (shape == Shape::kBall) {
    dMassSetSphereTotal(&mass, mass_kg, 0.5 * s.x());
  } else if (shape == Shape::kCapsule) {
    dMassSetCapsuleTotal(&mass, mass_kg, axis, 0.5 * s.x(), s.y());
  } else {
    dMassSetBoxTotal(&mass, mass_kg, s.x(), s.y(), s.z());
  }
}

Isometry3d PoseOf(const Vector3d& position_m, const Quaterniond& orientation) {
  Isometry3d pose(orientation.normalized());
  pose.pretranslate(position_m);
  return pose;
}

void RequireFinite(const char* what, const Vector3d& a, const Vector3d& b) {
  if (a.allFinite() && b.allFinite()) return;
  throw std::invalid_argument(std::string(what) + ": numbers must be finite");
}

/// A part's pose in the object's frame, in ODE's convention: capsules along z, ours along y.
struct PlacedPart {
  Shape shape;
  Vector3d size_m;
  Isometry3d pose;
};

std::vector<PlacedPart> PartsOf(const ObjectOptions& options) {
  std::vector<PlacedPart> parts = {{options.shape, options.size_m, Isometry3d::Identity()}};
  for (const ObjectPart& part : options.parts) {
    parts.push_back({part.shape, part.size_m, PoseOf(part.position_m, part.orientation)});
  }
  for (PlacedPart& part : parts) {
    if (part.shape != Shape::kCapsule) continue;
    part.pose.rotate(Eigen::AngleAxisd(-0.5 * M_PI, Vector3d::UnitX()));
  }
  return parts;
}

void Turn(const Isometry3d& pose, dMatrix3 rotation) {
  const Quaterniond q(pose.linear());
  const dQuaternion quaternion = {q.w(), q.x(), q.y(), q.z()};
  dQtoR(quaternion, rotation);
}

/// Sums the masses of all parts, of one density, about their centre, which is returned.
Vector3d SumMasses(const std::vector<PlacedPart>& parts, double mass_kg, dMass& sum) {
  double volume = 0.0;
  for (const PlacedPart& part : parts) volume += VolumeOf(part.shape, part.size_m);
  dMassSetZero(&sum);
  for (const PlacedPart& part : parts) {
    dMass mass;
    SetMass(part.shape, part.size_m, mass_kg * VolumeOf(part.shape, part.size_m) / volume, 3, mass);
    dMatrix3 rotation;
    Turn(part.pose, rotation);
    dMassRotate(&mass, rotation);
    const Vector3d at = part.pose.translation();
    dMassTranslate(&mass, at.x(), at.y(), at.z());
    dMassAdd(&sum, &mass);
  }
  const Vector3d middle = ToEigen(sum.c);
  dMassTranslate(&sum, -middle.x(), -middle.y(), -middle.z());
  sum.c[0] = sum.c[1] = sum.c[2] = 0.0;
  return middle;
}

/// A single shape is not summed, which would round its inertia.
Vector3d SetMassOf(dBodyID body, const ObjectOptions& options,
                   const std::vector<PlacedPart>& parts) {
  dMass mass;
  Vector3d middle = Vector3d::Zero();
  if (options.parts.empty()) {
    SetMass(options.shape, options.size_m, options.mass_kg, 2, mass);
  } else {
    middle = SumMasses(parts, options.mass_kg, mass);
  }
  dBodySetMass(body, &mass);
  return middle;
}

}  // namespace

Thing& World::Impl::MakeThing(int object, const ObjectOptions& object_options) {
  const std::vector<PlacedPart> parts = PartsOf(object_options);
  Thing& thing = things[object];
  thing.info = object_options;
  thing.made = ode.made++;
  thing.body = dBodyCreate(ode.world);
  thing.middle_m = SetMassOf(thing.body, object_options, parts);
  dBodySetMaxAngularSpeed(thing.body, 100.0);
  dBodySetDamping(thing.body, 0.0005, 0.005);  // air and rolling resistance
  if (!thing.IsMoved()) dBodySetKinematic(thing.body);
  for (const PlacedPart& part : parts) {
    const dGeomID geom = MakeGeom(ode.space, part.shape, part.size_m);
    thing.geoms.push_back(geom);
    dGeomSetBody(geom, thing.body);
    dGeomSetData(geom, reinterpret_cast<void*>(static_cast<intptr_t>(-(object + 1))));
    const Vector3d at = part.pose.translation() - thing.middle_m;
    if (at.isZero() && part.pose.linear().isIdentity()) continue;
    dMatrix3 rotation;
    Turn(part.pose, rotation);
    dGeomSetOffsetPosition(geom, at.x(), at.y(), at.z());
    dGeomSetOffsetRotation(geom, rotation);
  }
  return thing;
}

void World::Impl::DestroyThing(Thing& thing) {
  Release(thing);
  for (const dGeomID geom : thing.geoms) dGeomDestroy(geom);
  dBodyDestroy(thing.body);
}

int World::AddObject(const ObjectOptions& options) {
  options.Check();
  const int object = impl_->next_thing++;
  impl_->MakeThing(object, options);
  ResetObject(object);
  return object;
}

void World::RemoveObject(int object) {
  Impl& w = *impl_;
  w.things.at(object);  // throws if there is none
  for (auto& [id, actor] : w.actors) {
    std::erase_if(actor->soft_constraint, [&](const auto& c) { return c.second.object == object; });
    std::erase_if(actor->hard_constraint,
                  [&](const auto& c) { return c.second->anchor().object == object; });
  }
  w.DestroyThing(w.things.at(object));
  w.things.erase(object);
}

void World::ResetObject(int object) {
  const ObjectOptions info = impl_->things.at(object).info;
  SetPose(object, info.position_m, info.orientation);
  SetObjectVelocity(object, info.velocity_m_s, info.angular_velocity_rad_s);
}

void World::SetPose(int object, const Vector3d& position_m, const Quaterniond& orientation) {
  RequireFinite("SetPose", position_m, orientation.vec());
  Thing& thing = impl_->things.at(object);
  impl_->Release(thing);
  thing.loads.clear();
  thing.goal.reset();
  const Vector3d p = PoseOf(position_m, orientation) * thing.middle_m;
  dBodySetPosition(thing.body, p.x(), p.y(), p.z());
  SetRotation(thing.body, orientation);
}

void World::SetObjectVelocity(int object, const Vector3d& v, const Vector3d& w) {
  RequireFinite("SetObjectVelocity", v, w);
  const Thing& thing = impl_->things.at(object);
  if (thing.info.kind == BodyKind::kStatic) return;
  dBodySetLinearVel(thing.body, v.x(), v.y(), v.z());
  dBodySetAngularVel(thing.body, w.x(), w.y(), w.z());
}

void World::MoveTo(int object, const Vector3d& position_m, const Quaterniond& orientation) {
  RequireFinite("MoveTo", position_m, orientation.vec());
  Thing& thing = impl_->things.at(object);
  if (thing.info.kind != BodyKind::kKinematic) {
    throw std::invalid_argument("MoveTo: object " + std::to_string(object) +
                                " must be kinematic; SetPose puts others somewhere");
  }
  thing.goal = PoseOf(PoseOf(position_m, orientation) * thing.middle_m, orientation);
}

void World::ApplyForceToObject(int object, const Vector3d& force_n, const Vector3d& at_m,
                               const Vector3d& torque_nm) {
  RequireFinite("ApplyForceToObject", force_n + torque_nm, at_m);
  Thing& thing = impl_->things.at(object);
  if (!thing.IsMoved()) return;
  // The force keeps its direction in the world; its point of application moves with the body, see
  // Substep.
  thing.loads.push_back({force_n, torque_nm, physics::PoseOf(thing.body).inverse() * at_m});
}

void World::ApplyImpulseToObject(int object, const Vector3d& impulse_ns, const Vector3d& at_m) {
  RequireFinite("ApplyImpulseToObject", impulse_ns, at_m);
  const Thing& thing = impl_->things.at(object);
  if (!thing.IsMoved()) return;
  dMass mass;
  dBodyGetMass(thing.body, &mass);
  Eigen::Matrix3d inertia;  // about the centre of mass, in the body's frame
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 3; ++c) inertia(r, c) = mass.I[r * 4 + c];
  }
  const Isometry3d pose = physics::PoseOf(thing.body);
  const Vector3d moment = pose.linear().transpose() * (at_m - pose.translation()).cross(impulse_ns);
  const Vector3d v = ToEigen(dBodyGetLinearVel(thing.body)) + impulse_ns / mass.mass;
  const Vector3d w =
      ToEigen(dBodyGetAngularVel(thing.body)) + pose.linear() * inertia.ldlt().solve(moment);
  dBodySetLinearVel(thing.body, v.x(), v.y(), v.z());
  dBodySetAngularVel(thing.body, w.x(), w.y(), w.z());
}

ObjectState World::ObjectOf(int object) const {
  const Thing& thing = impl_->things.at(object);
  const Isometry3d pose = physics::PoseOf(thing.body);
  return {pose * -thing.middle_m, QuaternionToEigen(dBodyGetQuaternion(thing.body)),
          ToEigen(dBodyGetLinearVel(thing.body)), ToEigen(dBodyGetAngularVel(thing.body))};
}

const ObjectOptions& World::ObjectInfo(int object) const { return impl_->things.at(object).info; }
int World::ObjectCount() const { return static_cast<int>(impl_->things.size()); }
std::vector<int> World::Objects() const {
  std::vector<int> numbers;
  for (const auto& [id, thing] : impl_->things) numbers.push_back(id);
  return numbers;
}

}  // namespace ossa::physics
