#include "tools/nite2/open_trackers_internal.h"

#include <chrono>
#include <thread>

#include "depth/base/error.h"
#include "tools/nite2/oni_thread_internal.h"

namespace ossa::nite2 {
namespace {

// A read that waits ends within a tenth of a second.
void WaitForEndOf(const std::vector<std::weak_ptr<LiveTracker>>& trackers) {
  constexpr std::chrono::seconds kLongest{5};  // by hand
  const auto deadline = std::chrono::steady_clock::now() + kLongest;
  for (const auto& tracker : trackers) {
    while (!tracker.expired() && std::chrono::steady_clock::now() < deadline) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  }
}

}  // namespace

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
  const auto session = std::make_shared<std::unique_ptr<depth::OpenNiSession>>();
  {
    const std::lock_guard lock(mutex_);
    if (begun_ == 0 || --begun_ > 0) return;
    *session = std::move(openni_);
    models_.reset();
  }
  std::vector<std::weak_ptr<LiveTracker>> closed;
  users.CloseAll(closed);
  hands.CloseAll(closed);
  const auto end = [session] {
    session->reset();
    OniThread::Instance().EndGeneration();
  };
  // Ends after the objects that are still closing. A callback must not wait for them, because they
  // wait for it.
  if (LiveTracker::InCallback()) return OniThread::Instance().Post(end);
  WaitForEndOf(closed);
  OniThread::Instance().Run(end);
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
