#pragma once
#include <NiteCTypes.h>

#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "depth/sensor/openni2/openni_session.h"
#include "tools/nite2/hand_tracker_internal.h"
#include "tools/nite2/user_tracker_internal.h"

namespace ossa::nite2 {

/// The open trackers of one kind, by handles that are never reused, so that old handles are
/// detected.
template <typename Tracker>
class OpenTrackers {
 public:
  using Handle = typename Tracker::Handle;

  Handle Add(std::shared_ptr<Tracker> tracker) {
    const std::lock_guard lock(mutex_);
    last_ += kStep;
    open_[last_] = std::move(tracker);
    return reinterpret_cast<Handle>(last_);
  }
  /// null if the handle is not open.
  std::shared_ptr<Tracker> Find(Handle handle) const {
    const std::lock_guard lock(mutex_);
    const auto found = open_.find(reinterpret_cast<uintptr_t>(handle));
    return found == open_.end() ? nullptr : found->second;
  }
  bool Close(Handle handle) {
    std::shared_ptr<Tracker> tracker;
    {
      const std::lock_guard lock(mutex_);
      const auto found = open_.find(reinterpret_cast<uintptr_t>(handle));
      if (found == open_.end()) return false;
      tracker = std::move(found->second);
      open_.erase(found);
    }
    tracker->Close();
    return true;
  }
  /// Adds them to `closed`, because other threads may still use them.
  void CloseAll(std::vector<std::weak_ptr<LiveTracker>>& closed) {
    std::map<uintptr_t, std::shared_ptr<Tracker>> open;
    {
      const std::lock_guard lock(mutex_);
      open.swap(open_);
    }
    for (const auto& [handle, tracker] : open) {
      tracker->Close();
      closed.push_back(tracker);
    }
  }

 private:
  static constexpr uintptr_t kStep = 16;  // looks like an address
  mutable std::mutex mutex_;
  std::map<uintptr_t, std::shared_ptr<Tracker>> open_;
  uintptr_t last_ = 0;
};

/// The library between niteInitialize and niteShutdown. One per process, like OpenNI2 itself; never
/// destroyed, because programs call it while they end.
class Session {
 public:
  static Session& Instance();

  /// Reference-counted. Throws InputError if OpenNI2 or a shipped model is missing.
  void Begin();
  /// The last call closes all trackers.
  void End();
  /// Throws InputError before Begin(), and if there is no such camera.
  NiteUserTrackerHandle OpenUserTracker(OniDeviceHandle device);
  NiteHandTrackerHandle OpenHandTracker(OniDeviceHandle device);

  OpenTrackers<UserTracker> users;
  OpenTrackers<HandTracker> hands;

 private:
  const tracker::ModelSet& Models() const;

  std::mutex mutex_;  // guards what follows
  int begun_ = 0;
  std::unique_ptr<depth::OpenNiSession> openni_;
  std::optional<tracker::ModelSet> models_;
};

}  // namespace ossa::nite2
