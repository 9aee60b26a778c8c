#include <algorithm>
#include <array>
#include <cmath>

#include "depth/sensor/drivers/freenect_camera_internal.h"
#include "depth/sensor/kinect_depth.h"

namespace ossa::depth {
namespace {

// Constants: of the Kinect v1 (libfreenect), the rest by hand.

constexpr size_t kPixels = 640 * 480;
constexpr double kTicksPerMicrosecond = 60.0;  // the Kinect's 32-bit clock
constexpr double kPeriod_us = 1e6 / 30.0;

freenect_depth_format FormatOf(KinectDepthMode mode) {
  switch (mode) {
    case KinectDepthMode::kRegistered:
      return FREENECT_DEPTH_REGISTERED;
    case KinectDepthMode::kMillimetres:
      return FREENECT_DEPTH_MM;
    case KinectDepthMode::kRaw:
      break;
  }
  return FREENECT_DEPTH_11BIT;
}

// Debian's fakenect asserts when asked for any mode but one, and then plays its files in any mode:
// a hand-made mode works for it and for a real Kinect.
freenect_frame_mode ModeOf(KinectDepthMode mode) {
  const freenect_depth_format format = FormatOf(mode);
  for (int i = 0; i < freenect_get_depth_mode_count(); ++i) {
    const freenect_frame_mode found = freenect_get_depth_mode(i);
    if (found.depth_format == format && found.width == 640) return found;
  }
  freenect_frame_mode made = freenect_get_depth_mode(0);
  made.depth_format = format;
  return made;
}

}  // namespace

FreenectCamera::FreenectCamera(freenect_context* context, std::recursive_mutex& library, int index,
                               KinectDepthMode mode)
    : library_(library), mode_(mode) {
  const std::lock_guard lock(library_);
  if (freenect_open_device(context, &device_, index) < 0) {
    device_ = nullptr;
    return;
  }
  freenect_set_user(device_, this);
  freenect_set_depth_callback(device_, OnDepth);
  if (freenect_set_depth_mode(device_, ModeOf(mode)) < 0) {
    freenect_close_device(device_);
    device_ = nullptr;
  }
}

FreenectCamera::~FreenectCamera() {
  Stop();
  const std::lock_guard lock(library_);
  if (device_ != nullptr) freenect_close_device(device_);
}

bool FreenectCamera::SetMode(KinectDepthMode mode) {
  const std::lock_guard lock(library_);
  if (running_ || freenect_set_depth_mode(device_, ModeOf(mode)) < 0) return false;
  mode_ = mode;
  return true;
}

bool FreenectCamera::Start() {
  {
    const std::lock_guard lock(mutex_);
    stopped_ = false;
    fresh_ = false;
  }
  const std::lock_guard lock(library_);
  running_ = freenect_start_depth(device_) == 0;
  return running_;
}

void FreenectCamera::Stop() {
  {
    const std::lock_guard lock(mutex_);
    stopped_ = true;
  }
  wake_.notify_all();
  const std::lock_guard lock(library_);
  if (running_) freenect_stop_depth(device_);
  running_ = false;
}

bool FreenectCamera::Fetch(KinectFrame* frame) {
  std::unique_lock lock(mutex_);
  wake_.wait(lock, [this] { return fresh_ || stopped_; });
  if (stopped_) return false;
  fresh_ = false;
  *frame = newest_;
  return true;
}

void FreenectCamera::OnDepth(freenect_device* device, void* depth, uint32_t ticks) {
  auto* camera = static_cast<FreenectCamera*>(freenect_get_user(device));
  camera->TakeDepth(static_cast<const uint16_t*>(depth), ticks);
}

// Runs on libfreenect's thread: only copies.
void FreenectCamera::TakeDepth(const uint16_t* depth, uint32_t ticks) {
  static const std::array<uint16_t, 2048> average = AverageKinectDepthTable();
  {
    const std::lock_guard lock(mutex_);
    newest_.depth_mm.resize(kPixels);
    if (mode_ == KinectDepthMode::kRaw) {
      std::transform(depth, depth + kPixels, newest_.depth_mm.begin(),
                     [](uint16_t raw) { return average[std::min<uint16_t>(raw, 2047)]; });
    } else {
      std::copy(depth, depth + kPixels, newest_.depth_mm.begin());
    }
    // The clock wraps every 72 s; unsigned differences handle that. USB packets, and frames with
    // them, may be lost: the time shows how many.
    const double passed_us = (ticks - last_ticks_) / kTicksPerMicrosecond;
    const int frames = std::max(1, static_cast<int>(std::lround(passed_us / kPeriod_us)));
    constexpr int kRestart = 300;  // ten seconds: the clock or a dump has restarted
    const bool steady = clock_known_ && frames < kRestart;
    newest_.index += steady ? frames : 1;
    newest_.timestamp_us += static_cast<uint64_t>(steady ? passed_us : kPeriod_us);
    last_ticks_ = ticks;
    clock_known_ = true;
    fresh_ = true;
  }
  wake_.notify_all();
}

bool FreenectCamera::GetTilt_deg(double* tilt_deg) {
  const std::lock_guard lock(library_);
  if (freenect_update_tilt_state(device_) < 0) return false;
  *tilt_deg = freenect_get_tilt_degs(freenect_get_tilt_state(device_));
  return true;
}

bool FreenectCamera::SetTilt_deg(double tilt_deg) {
  constexpr double kMost_deg = 27.0;  // the motor's range
  if (!(std::abs(tilt_deg) <= kMost_deg)) return false;
  const std::lock_guard lock(library_);
  return freenect_set_tilt_degs(device_, tilt_deg) >= 0;
}

bool FreenectCamera::GetAcceleration(double* xyz_mps2) {
  const std::lock_guard lock(library_);
  if (freenect_update_tilt_state(device_) < 0) return false;
  freenect_get_mks_accel(freenect_get_tilt_state(device_), xyz_mps2, xyz_mps2 + 1, xyz_mps2 + 2);
  return true;
}

}  // namespace ossa::depth
