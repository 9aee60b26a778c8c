#pragma once
#include <NiteCTypes.h>

#include <atomic>
#include <memory>
#include <mutex>
#include <vector>

#include "tools/nite2/depth_camera_internal.h"
#include "tools/tracker/tracker.h"

namespace ossa::nite2 {

/// A program's callbacks; all NiTE trackers have the same one.
struct Callback {
  const void* key = nullptr;  // the program's structure
  OniGeneralCallback ready = nullptr;
  void* cookie = nullptr;
};

/// Shared by user and hand trackers: a camera, people in its images, and callbacks for frames.
/// Frames are read on the thread that requests one. All members may be called from any
/// thread, also from a callback.
class LiveTracker : public std::enable_shared_from_this<LiveTracker> {
 public:
  LiveTracker(OniDeviceHandle device, const tracker::ModelSet& models);
  virtual ~LiveTracker();
  LiveTracker(const LiveTracker&) = delete;
  LiveTracker& operator=(const LiveTracker&) = delete;

  /// Ends waiting reads; new ones fail.
  void Close();
  /// Whether this thread is in a callback of any tracker.
  static bool InCallback();
  bool AddCallback(const Callback& callback);
  /// Returns when the callback is not running, unless called from it.
  void RemoveCallback(const void* key);
  /// Between millimetres and pixels of the whole image, as OpenNI2 does; false if impossible.
  bool ToPixel(float x, float y, float z, float* pixel_x, float* pixel_y) const;
  bool ToPoint(int pixel_x, int pixel_y, int z, float* x, float* y) const;

 protected:
  /// Waits for the next frame; empty after two seconds, if the device is gone, or if the tracker is
  /// closed. Under `reading_`.
  std::optional<CameraFrame> NextFrame();

  std::mutex reading_;  // held while a frame is read and worked on
  tracker::Tracker people_;

 private:
  void CallCallbacks();

  std::unique_ptr<DepthCamera> camera_;
  std::atomic<bool> closing_ = false;
  std::recursive_mutex telling_;  // held while callbacks run; guards `callbacks_`
  std::vector<Callback> callbacks_;
  std::mutex watching_;  // guards `told_`
  bool told_ = false;    // whether the camera reports frames
};

}  // namespace ossa::nite2
