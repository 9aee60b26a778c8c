#include "tools/nite2/live_tracker_internal.h"

#include <algorithm>
#include <chrono>
#include <thread>

namespace ossa::nite2 {
namespace {

using std::chrono::milliseconds;

// Constants: by hand.

constexpr milliseconds kPatience{2000};  // then a camera that says nothing is an error
constexpr milliseconds kSlice{100};      // between looks whether the tracker is closed

tracker::TrackerOptions OptionsOf(const tracker::ModelSet& models) {
  tracker::TrackerOptions options;
  options.models = models;
  return options;
}

// Cameras that are being closed on threads of their own.
std::atomic<int> closing_cameras = 0;

}  // namespace

LiveTracker::LiveTracker(OniDeviceHandle device, const tracker::ModelSet& models)
    : people_(OptionsOf(models)), camera_(std::make_unique<DepthCamera>(device)) {}

LiveTracker::~LiveTracker() {
  Close();
  if (!camera_->InCall()) return;
  // Closed by its own callback, on the camera's thread: that must come to its end first.
  ++closing_cameras;
  std::thread([camera = std::move(camera_)]() mutable {
    camera.reset();
    --closing_cameras;
  }).detach();
}

void LiveTracker::WaitForClosing() {
  while (closing_cameras > 0) std::this_thread::sleep_for(milliseconds(1));
}

void LiveTracker::Close() {
  closing_ = true;
  if (camera_->InCall()) return;
  const std::lock_guard lock(watching_);
  camera_->StopTelling();
  told_ = false;
}

bool LiveTracker::AddCallback(const Callback& callback) {
  if (closing_) return false;
  {
    const std::lock_guard lock(telling_);
    callbacks_.push_back(callback);
  }
  const std::lock_guard lock(watching_);
  if (!told_) {
    camera_->TellOfFrames([weak = weak_from_this()] {
      if (const auto self = weak.lock()) self->TellAll();
    });
  }
  told_ = true;
  return true;
}

void LiveTracker::RemoveCallback(const void* key) {
  const std::lock_guard lock(telling_);
  callbacks_.erase(std::remove_if(callbacks_.begin(), callbacks_.end(),
                                  [&](const Callback& c) { return c.key == key; }),
                   callbacks_.end());
}

void LiveTracker::TellAll() {
  if (closing_) return;
  const std::lock_guard lock(telling_);
  const auto callbacks = callbacks_;
  for (const Callback& callback : callbacks) {
    const bool still_there = std::any_of(callbacks_.begin(), callbacks_.end(),
                                         [&](const Callback& c) { return c.key == callback.key; });
    if (still_there && !closing_) callback.ready(callback.cookie);
  }
}

std::optional<CameraFrame> LiveTracker::NextFrame() {
  const auto deadline = std::chrono::steady_clock::now() + kPatience;
  while (!closing_ && std::chrono::steady_clock::now() < deadline) {
    const WaitResult result = camera_->Wait(kSlice);
    if (result == WaitResult::kFrame) return camera_->Read();
    if (result == WaitResult::kGone) break;
  }
  return std::nullopt;
}

}  // namespace ossa::nite2
