#pragma once
// Wraps libfreenect with a lock and a thread, for the OpenNI2 driver.
#include <libfreenect.h>

#include <condition_variable>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace ossa::depth {

/// libfreenect's depth modes.
enum class KinectDepthMode {
  kRegistered,   // millimetres, aligned with the colour camera
  kMillimetres,  // millimetres in the depth camera's view
  kRaw,          // raw depths, converted with an average calibration: for dumps
};

/// A frame handed from the Kinect's USB thread to a stream.
struct KinectFrame {
  std::vector<uint16_t> depth_mm;
  uint64_t timestamp_us = 0;
  int index = 0;
};

/// An open Kinect v1. Thread-safe.
class FreenectCamera {
 public:
  FreenectCamera(freenect_context* context, std::recursive_mutex& library, int index,
                 KinectDepthMode mode);
  ~FreenectCamera();
  FreenectCamera(const FreenectCamera&) = delete;
  FreenectCamera& operator=(const FreenectCamera&) = delete;

  bool is_open() const { return device_ != nullptr; }
  bool SetMode(KinectDepthMode mode);
  KinectDepthMode mode() const { return mode_; }
  bool Start();
  void Stop();

  /// Waits for a frame newer than the last fetched; false when stopped. Frames in between are lost;
  /// the index shows how many.
  bool Fetch(KinectFrame* frame);

  /// The tilt motor, degrees above the horizon; the accelerometer, m/s²: x to the Kinect's right, y
  /// up, z forward.
  bool GetTilt_deg(double* tilt_deg);
  bool SetTilt_deg(double tilt_deg);
  bool GetAcceleration(double* xyz_mps2);

 private:
  static void OnDepth(freenect_device* device, void* depth, uint32_t ticks);
  void TakeDepth(const uint16_t* depth, uint32_t ticks);

  std::recursive_mutex& library_;  // libfreenect is not thread-safe
  freenect_device* device_ = nullptr;
  KinectDepthMode mode_;
  bool running_ = false;

  std::mutex mutex_;  // guards the members below
  std::condition_variable wake_;
  KinectFrame newest_;
  bool fresh_ = false;
  bool stopped_ = true;
  bool clock_known_ = false;
  uint32_t last_ticks_ = 0;
};

}  // namespace ossa::depth
