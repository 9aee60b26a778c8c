#pragma once
#include <OniCAPI.h>

#include <atomic>
#include <chrono>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "depth/image/depth_frame.h"
#include "depth/sensor/sensor_clock.h"

namespace ossa::nite2 {

/// Returns an OniFrame to OpenNI2, unless it was returned already: the PyPI package openni releases
/// depth frames to which it holds no reference.
class OniFrameReleaser {
 public:
  OniFrameReleaser() = default;
  explicit OniFrameReleaser(const OniFrame& frame);
  void operator()(OniFrame* frame) const;

 private:
  // Identifies the frame, in case its memory is reused.
  const void* data_ = nullptr;
  int index_ = 0;
  uint64_t timestamp_us_ = 0;
  int generation_ = 0;
};
using OniFramePtr = std::unique_ptr<OniFrame, OniFrameReleaser>;

/// One frame: as OpenNI2 delivered it, and as ossa's depth image.
struct CameraFrame {
  OniFramePtr delivered;
  depth::DepthFrame image;  // never mirrored
  bool mirrored = false;    // whether `delivered` is
};

/// A separate depth stream on an OpenNI2 device. The device stays open for it, even if the program
/// closes its own handle. Next() is for one thread at a time.
class DepthCamera {
 public:
  /// null: the first device. Throws InputError if there is none, or none with a depth stream.
  explicit DepthCamera(OniDeviceHandle device);
  ~DepthCamera();
  DepthCamera(const DepthCamera&) = delete;
  DepthCamera& operator=(const DepthCamera&) = delete;

  /// The next frame; empty after `timeout`. Throws InputError if it is not a depth frame.
  std::optional<CameraFrame> Next(std::chrono::milliseconds timeout);
  /// Whether the device was unplugged.
  bool is_gone() const { return gone_; }

  /// Sets a callback that a thread of OpenNI2 calls for every frame, until the next call or
  /// RemoveFrameCallback().
  void SetFrameCallback(std::function<void()> on_frame);
  /// Returns when no callback is running, unless called from it.
  void RemoveFrameCallback();
  /// Whether this thread is running the callback: OpenNI2 cannot end that thread from itself.
  bool IsInCallback() const;

  /// Parameters of OpenNI2's conversions between millimetres and pixels.
  struct Geometry {
    int width = 0, height = 0;                // of the whole image
    double across_rad = 0.0, down_rad = 0.0;  // fields of view
    bool mirrored = false;
    double focal_x() const;  // pixels
    double focal_y() const;
  };
  /// Geometry of the newest frame. Thread-safe.
  Geometry geometry() const;

 private:
  void Open(OniDeviceHandle device);
  void Close();
  void ReadGeometry();
  static void ONI_CALLBACK_TYPE OnDisconnected(const OniDeviceInfo* info, void* camera);
  static void ONI_CALLBACK_TYPE OnFrame(OniStreamHandle stream, void* camera);

  OniDeviceHandle device_ = nullptr;
  OniStreamHandle stream_ = nullptr;
  int generation_ = 0;
  OniCallbackHandle device_callback_ = nullptr;
  OniCallbackHandle frame_callback_ = nullptr;
  OniDeviceCallbacks device_callbacks_{};
  std::string uri_;
  std::atomic<bool> gone_ = false;
  mutable std::mutex looking_;  // guards `geometry_`
  Geometry geometry_;
  std::function<void()> on_frame_;
  int64_t frames_ = 0;
  depth::SensorClock clock_;
};

}  // namespace ossa::nite2
