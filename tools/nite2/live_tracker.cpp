#include "tools/nite2/live_tracker_internal.h"

#include <algorithm>
#include <chrono>

#include "tools/nite2/oni_thread_internal.h"

namespace ossa::nite2 {
namespace {

using std::chrono::milliseconds;

// Constants: by hand.

constexpr milliseconds kPatience{2000};  // after this time without frames a camera is an error
constexpr milliseconds kSlice{100};      // between checks whether the tracker is closed

tracker::TrackerOptions MakeOptions(const tracker::ModelSet& models) {
  tracker::TrackerOptions options;
  options.models = models;
  return options;
}

thread_local int callbacks_deep = 0;

}  // namespace

LiveTracker::LiveTracker(OniDeviceHandle device, const tracker::ModelSet& models)
    : people_(MakeOptions(models)), camera_(std::make_unique<DepthCamera>(device)) {}

LiveTracker::~LiveTracker() {
  Close();
  if (!camera_->IsInCallback()) return;
  // Closed by its own callback, on the camera's thread: that must come to its end first.
  OniThread::Instance().Post(
      [camera = std::shared_ptr<DepthCamera>(std::move(camera_))]() mutable { camera.reset(); });
}

bool LiveTracker::InCallback() { return callbacks_deep > 0; }

void LiveTracker::Close() {
  closing_ = true;
  if (camera_->IsInCallback()) return;
  const std::lock_guard lock(watching_);
  camera_->RemoveFrameCallback();
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
    camera_->SetFrameCallback([weak = weak_from_this()] {
      if (const auto self = weak.lock()) self->CallCallbacks();
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

void LiveTracker::CallCallbacks() {
  if (closing_) return;
  const std::lock_guard lock(telling_);
  const auto callbacks = callbacks_;
  for (const Callback& callback : callbacks) {
    const bool still_there = std::any_of(callbacks_.begin(), callbacks_.end(),
                                         [&](const Callback& c) { return c.key == callback.key; });
    if (!still_there || closing_) continue;
    ++callbacks_deep;
    callback.ready(callback.cookie);
    --callbacks_deep;
  }
}

std::optional<CameraFrame> LiveTracker::NextFrame() {
  const auto deadline = std::chrono::steady_clock::now() + kPatience;
  while (!closing_ && std::chrono::steady_clock::now() < deadline) {
    std::optional<CameraFrame> frame = camera_->Next(kSlice);
    // An available frame is returned even if the device has just gone.
    if (frame || camera_->is_gone()) return frame;
  }
  return std::nullopt;
}

bool LiveTracker::ToPixel(float x, float y, float z, float* pixel_x, float* pixel_y) const {
  if (!(z > 0.0F)) return false;
  const DepthCamera::Geometry seen = camera_->geometry();
  *pixel_x = static_cast<float>(seen.width / 2.0 + seen.focal_x() * x / z);
  *pixel_y = static_cast<float>(seen.height / 2.0 - seen.focal_y() * y / z);
  return true;
}

bool LiveTracker::ToPoint(int pixel_x, int pixel_y, int z, float* x, float* y) const {
  const DepthCamera::Geometry seen = camera_->geometry();
  *x = static_cast<float>((pixel_x - seen.width / 2.0) * z / seen.focal_x());
  *y = static_cast<float>((seen.height / 2.0 - pixel_y) * z / seen.focal_y());
  return true;
}

}  // namespace ossa::nite2
