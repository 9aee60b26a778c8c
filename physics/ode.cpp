#include <algorithm>
#include <mutex>

#include "physics/ode_internal.h"

namespace ossa::physics {
namespace {

std::mutex& OdeMutex() {
  static std::mutex mutex;
  return mutex;
}

}  // namespace

void PrepareOde() {
  static std::once_flag once;
  std::call_once(once, [] { dInitODE2(0); });
  thread_local const bool ready = [] {
    const std::scoped_lock lock(OdeMutex());
    return dAllocateODEDataForThread(static_cast<unsigned>(dAllocateMaskAll)) != 0;
  }();
  (void)ready;
}

void SeededQuickStep(dWorldID world, double h_s, uint64_t seed) {
  const std::scoped_lock lock(OdeMutex());
  dRandSetSeed(static_cast<unsigned long>(seed & 0xffffffffU));
  dWorldQuickStep(world, h_s);
}

BodyMemory Remember(dBodyID body) {
  BodyMemory memory;
  std::copy_n(dBodyGetPosition(body), 3, memory.position.begin());
  std::copy_n(dBodyGetLinearVel(body), 3, memory.velocity.begin());
  std::copy_n(dBodyGetAngularVel(body), 3, memory.turning.begin());
  std::copy_n(dBodyGetQuaternion(body), 4, memory.quaternion.begin());
  std::copy_n(dBodyGetRotation(body), 12, memory.rotation.begin());
  return memory;
}

void Recall(dBodyID body, const BodyMemory& memory) {
  const auto& [p, v, w, q, r] = memory;
  // ODE's own setter normalises and changes bits. The pointers point into the body.
  std::copy(q.begin(), q.end(), const_cast<dReal*>(dBodyGetQuaternion(body)));
  std::copy(r.begin(), r.end(), const_cast<dReal*>(dBodyGetRotation(body)));
  dBodySetPosition(body, p[0], p[1], p[2]);
  dBodySetLinearVel(body, v[0], v[1], v[2]);
  dBodySetAngularVel(body, w[0], w[1], w[2]);
  dBodySetForce(body, 0, 0, 0);
  dBodySetTorque(body, 0, 0, 0);
}

OdeWorld::OdeWorld() {
  PrepareOde();
  world = dWorldCreate();
  space = dHashSpaceCreate(nullptr);
  contacts = dJointGroupCreate(0);
}

OdeWorld::~OdeWorld() {
  dJointGroupDestroy(contacts);
  dSpaceDestroy(space);
  dWorldDestroy(world);
}

}  // namespace ossa::physics
