#include "tools/nite2/session_internal.h"

#include "depth/base/error.h"
#include "tools/nite2/oni_thread_internal.h"

namespace ossa::nite2 {

Session& Session::Instance() {
  static auto* instance = new Session;
  return *instance;
}

void Session::Begin() {
  const std::lock_guard lock(mutex_);
  if (begun_ == 0) {
    if (!models_) models_ = tracker::ModelSet::Shipped();
    OniThread::Instance().Run([this] { openni_ = std::make_unique<depth::OpenNiSession>(); });
  }
  ++begun_;
}

void Session::End() {
  std::shared_ptr<depth::OpenNiSession> session;
  {
    const std::lock_guard lock(mutex_);
    if (begun_ == 0 || --begun_ > 0) return;
    session = std::move(openni_);
    models_.reset();
  }
  users.CloseAll();
  hands.CloseAll();
  // After what is still being closed; which a callback must not wait for, being waited for itself.
  if (LiveTracker::InCallback()) {
    OniThread::Instance().Post([session = std::move(session)]() mutable { session.reset(); });
  } else {
    OniThread::Instance().Run([&session] { session.reset(); });
  }
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
