#include "tools/nite2/session_internal.h"

#include "depth/base/error.h"

namespace ossa::nite2 {

Session& Session::Instance() {
  static auto* instance = new Session;
  return *instance;
}

void Session::Begin() {
  const std::lock_guard lock(mutex_);
  if (begun_ == 0) {
    if (!models_) models_ = tracker::ModelSet::Shipped();
    openni_.emplace();
  }
  ++begun_;
}

void Session::End() {
  const std::lock_guard lock(mutex_);
  if (begun_ == 0 || --begun_ > 0) return;
  users.CloseAll();
  hands.CloseAll();
  LiveTracker::WaitForClosing();
  openni_.reset();
  models_.reset();
}

const tracker::ModelSet& Session::Models() const {
  if (begun_ == 0) throw InputError("NiTE: niteInitialize has not been called");
  return *models_;
}

NiteUserTrackerHandle Session::OpenUserTracker(OniDeviceHandle device) {
  const std::lock_guard lock(mutex_);
  return users.Add(std::make_shared<UserTracker>(device, Models()));
}

NiteHandTrackerHandle Session::OpenHandTracker(OniDeviceHandle device) {
  const std::lock_guard lock(mutex_);
  return hands.Add(std::make_shared<HandTracker>(device, Models()));
}

}  // namespace ossa::nite2
