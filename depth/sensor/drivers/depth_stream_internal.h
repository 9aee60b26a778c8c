#pragma once
// Common part of our drivers' depth streams: properties, mirroring, and delivery of frames.
#include <array>
#include <atomic>
#include <cstdint>
#include <vector>

#include "depth/image/camera.h"
#include "depth/sensor/drivers/driver_api_internal.h"

namespace ossa::depth {

/// The mode at half the resolution in both directions.
OniVideoMode HalveMode(OniVideoMode mode);

class DepthStream : public oni::driver::StreamBase {
 public:
  /// `max_value`: greater than every depth of the stream (OpenNI2's recorder relies on it). If
  /// `offers_half` is set, the size can be chosen until the first frame.
  DepthStream(const Camera& camera, int fps, int max_value, bool mirrored,
              bool offers_half = false);

  OniStatus getProperty(int id, void* data, int* size) override;
  OniStatus setProperty(int id, const void* data, int size) override;
  OniBool isPropertySupported(int id) override;
  int getRequiredFrameSize() override;

 protected:
  /// Delivers an image of the camera's size to all listeners, at the size they chose; called on the
  /// driver's thread.
  void Deliver(const uint16_t* depth_mm, int frame_index, uint64_t timestamp_us);

  /// The camera of the current images, of the constructor's size.
  virtual Camera CurrentCamera() const { return camera_; }

 private:
  OniStatus SetVideoMode(const OniVideoMode& mode);

  Camera camera_;  // full size
  OniVideoMode mode_{};
  bool offers_half_;
  int step_ = 1;  // subsampling step of rows and columns
  int max_value_;
  std::atomic<bool> mirrored_;
  std::atomic<bool> delivered_ = false;  // the size is fixed
};

}  // namespace ossa::depth
