#pragma once
#include <OniCAPI.h>

#include <atomic>
#include <chrono>
#include <functional>
#include <memory>
#include <mutex>
#include <string>

#include "depth/image/depth_frame.h"

namespace ossa::nite2 {

/// Gives an OniFrame back to OpenNI2.
struct OniFrameReleaser {
  void operator()(OniFrame* frame) const { oniFrameRelease(frame); }
};
using OniFramePtr = std::unique_ptr<OniFrame, OniFrameReleaser>;

/// One moment: as OpenNI2 delivered it, and as ossa sees it.
struct CameraFrame {
  OniFramePtr delivered;
  depth::DepthFrame image;  // never mirrored
  bool mirrored = false;    // whether `delivered` is
};

/// What a wait for a frame ended with.
enum class WaitResult { kFrame, kTimeout, kGone };

/// A depth stream of our own on an OpenNI2 device. The device is held open for it, whatever the
/// program does with its own handle. Wait and Read: one thread at a time.
class DepthCamera {
 public:
  /// null: the first device there is. Throws InputError where there is none, or none with depths.
  explicit DepthCamera(OniDeviceHandle device);
  ~DepthCamera();
  DepthCamera(const DepthCamera&) = delete;
  DepthCamera& operator=(const DepthCamera&) = delete;

  WaitResult Wait(std::chrono::milliseconds timeout);
  /// The frame that was waited for; throws InputError where it cannot be read.
  CameraFrame Read();

  /// Called on a thread of OpenNI2 for every frame that comes, until the next call or StopTelling.
  void TellOfFrames(std::function<void()> on_frame);
  /// Returns when no call is under way, unless on the very thread.
  void StopTelling();
  /// Whether this thread is in such a call: OpenNI2 cannot end that thread from itself.
  bool InCall() const;

  /// Between millimetres and pixels, as OpenNI2 does it; false where it cannot.
  bool ToPixel(float x, float y, float z, float* pixel_x, float* pixel_y) const;
  bool ToPoint(int pixel_x, int pixel_y, int z, float* x, float* y) const;

 private:
  void Open(OniDeviceHandle device);
  void Close();
  bool IsMirrored() const;
  double TimeOf(const OniFrame& frame);
  static void ONI_CALLBACK_TYPE OnGone(const OniDeviceInfo* info, void* camera);
  static void ONI_CALLBACK_TYPE OnFrame(OniStreamHandle stream, void* camera);

  OniDeviceHandle device_ = nullptr;
  OniStreamHandle stream_ = nullptr;
  OniCallbackHandle device_callback_ = nullptr;
  OniCallbackHandle frame_callback_ = nullptr;
  OniDeviceCallbacks device_callbacks_{};
  std::string uri_;
  std::atomic<bool> gone_ = false;
  std::function<void()> on_frame_;
  int64_t frames_ = 0;
  uint64_t last_us_ = 0;
  double offset_s_ = 0.0;  // our time minus the sensor's, whose clock may begin anew
};

}  // namespace ossa::nite2
