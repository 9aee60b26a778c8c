#include <stdexcept>

#include "physics/world.h"
#include "physics/world_internal.h"

namespace ossa::physics {
namespace {

using Eigen::Vector3d;

dGeomID MakeGeom(dSpaceID space, const ObjectOptions& options, dMass& mass) {
  const Vector3d& s = options.size_m;
  switch (options.shape) {
    case Shape::kBall:
      dMassSetSphereTotal(&mass, options.mass_kg, 0.5 * s.x());
      return dCreateSphere(space, 0.5 * s.x());
    case Shape::kCapsule: {
      dMassSetCapsuleTotal(&mass, options.mass_kg, 2, 0.5 * s.x(), s.y());
      return dCreateCapsule(space, 0.5 * s.x(), s.y());
    }
    case Shape::kBox:
      break;
  }
  dMassSetBoxTotal(&mass, options.mass_kg, s.x(), s.y(), s.z());
  return dCreateBox(space, s.x(), s.y(), s.z());
}

}  // namespace

int World::AddObject(const ObjectOptions& options) {
  options.Check();
  Impl& w = *impl_;
  Thing thing;
  thing.info = options;
  dMass mass;
  thing.body = dBodyCreate(w.ode.world);
  thing.geom = MakeGeom(w.ode.space, options, mass);
  dBodySetMass(thing.body, &mass);
  dBodySetMaxAngularSpeed(thing.body, 100.0);
  dBodySetDamping(thing.body, 0.0005, 0.005);  // what air and rolling take away
  dGeomSetBody(thing.geom, thing.body);
  if (options.shape == Shape::kCapsule) {
    dMatrix3 z_to_y;
    dRFromAxisAndAngle(z_to_y, 1, 0, 0, -0.5 * M_PI);
    dGeomSetOffsetRotation(thing.geom, z_to_y);
  }
  const Vector3d& p = options.position_m;
  const Vector3d& v = options.velocity_m_s;
  dBodySetPosition(thing.body, p.x(), p.y(), p.z());
  SetRotation(thing.body, options.orientation);
  dBodySetLinearVel(thing.body, v.x(), v.y(), v.z());
  const int index = static_cast<int>(w.things.size());
  dGeomSetData(thing.geom, reinterpret_cast<void*>(static_cast<intptr_t>(-(index + 1))));
  w.things.push_back(thing);
  return index;
}

void World::Hold(int character, recon::Joint joint, int object, bool rigid) {
  Release(object);
  Impl& w = *impl_;
  const Character& hand = w.actors.at(static_cast<size_t>(character))->character;
  Thing& thing = w.things.at(static_cast<size_t>(object));
  const auto index = Index(joint);
  const dBodyID body = hand.body(hand.BodyOfJoint(index));
  thing.held =
      rigid ? dJointCreateFixed(w.ode.world, nullptr) : dJointCreateBall(w.ode.world, nullptr);
  dJointAttach(thing.held, body, thing.body);
  thing.hand = body;
  thing.in_hand = PoseOf(body).inverse() * PoseOf(thing.body);
  thing.beside = hand.body(BodyParentOf(hand.BodyOfJoint(index)));
  if (rigid) {
    dJointSetFixed(thing.held);
  } else {
    const Vector3d at = hand.JointPosition(index);
    dJointSetBallAnchor(thing.held, at.x(), at.y(), at.z());
  }
}

void World::Release(int object) {
  Thing& thing = impl_->things.at(static_cast<size_t>(object));
  if (thing.held != nullptr) dJointDestroy(thing.held);
  thing.held = nullptr;
  thing.hand = nullptr;
  thing.beside = nullptr;
}

void World::Hang(int object, const Vector3d& point_m) {
  Release(object);
  Thing& thing = impl_->things.at(static_cast<size_t>(object));
  thing.held = dJointCreateBall(impl_->ode.world, nullptr);
  dJointAttach(thing.held, thing.body, nullptr);
  dJointSetBallAnchor(thing.held, point_m.x(), point_m.y(), point_m.z());
}

ObjectState World::ObjectOf(int object) const {
  const Thing& thing = impl_->things.at(static_cast<size_t>(object));
  return {ToEigen(dBodyGetPosition(thing.body)), QuaternionToEigen(dBodyGetQuaternion(thing.body)),
          ToEigen(dBodyGetLinearVel(thing.body))};
}

const ObjectOptions& World::ObjectInfo(int object) const {
  return impl_->things.at(static_cast<size_t>(object)).info;
}

}  // namespace ossa::physics
