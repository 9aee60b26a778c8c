#pragma once
// What the depth streams of our drivers share: properties, mirroring, and handing a frame over.
#include <array>
#include <atomic>
#include <cstdint>
#include <vector>

#include "depth/image/camera.h"
#include "depth/sensor/drivers/driver_api_internal.h"

namespace ossa::depth {

/// The mode of every second pixel of every second row.
OniVideoMode HalveMode(OniVideoMode mode);

class DepthStream : public oni::driver::StreamBase {
 public:
  /// `max_value`: strictly above every depth the stream gives (OpenNI2's recorder relies on it).
  /// Streams that offer half the size do so until they deliver.
  DepthStream(const Camera& camera, int fps, int max_value, bool mirrored,
              bool offers_half = false);

  OniStatus getProperty(int id, void* data, int* size) override;
  OniStatus setProperty(int id, const void* data, int size) override;
  OniBool isPropertySupported(int id) override;
  int getRequiredFrameSize() override;

 protected:
  /// Copies an image, which must be of the camera's size, out to whoever listens, in the size that
  /// they chose; called on the driver's thread.
  void Deliver(const uint16_t* depth_mm, int frame_index, uint64_t timestamp_us);

  /// That the images are of now, of the constructor's size.
  virtual Camera CurrentCamera() const { return camera_; }

 private:
  OniStatus SetVideoMode(const OniVideoMode& mode);

  Camera camera_;  // whole
  OniVideoMode mode_{};
  bool offers_half_;
  int step_ = 1;  // every so many pixels of a row, and rows, are delivered
  int max_value_;
  std::atomic<bool> mirrored_;
  std::atomic<bool> delivered_ = false;  // the size stays
};

}  // namespace ossa::depth
