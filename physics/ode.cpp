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
