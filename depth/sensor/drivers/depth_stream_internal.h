#pragma once
// What the depth streams of our drivers share: properties, mirroring, and handing a frame over.
#include <array>
#include <atomic>
#include <cstdint>
#include <vector>

#include "depth/image/camera.h"
#include "depth/sensor/drivers/driver_api_internal.h"

namespace ossa::depth {

class DepthStream : public oni::driver::StreamBase {
 public:
  /// `max_value`: strictly above every depth the stream gives (OpenNI2's recorder relies on it).
  DepthStream(const Camera& camera, int fps, int max_value, bool mirrored);

  OniStatus getProperty(int id, void* data, int* size) override;
  OniStatus setProperty(int id, const void* data, int size) override;
  OniBool isPropertySupported(int id) override;
  int getRequiredFrameSize() override;

 protected:
  /// Copies an image, which must be of the stream's size, out to whoever listens; called on the
  /// driver's thread.
  void Deliver(const uint16_t* depth_mm, int frame_index, uint64_t timestamp_us);

 private:
  Camera camera_;
  OniVideoMode mode_{};
  int max_value_;
  std::atomic<bool> mirrored_;
};

}  // namespace ossa::depth
