#include <algorithm>
#include <cmath>

#include "depth/sensor/drivers/camera_property_internal.h"
#include "depth/sensor/drivers/depth_stream_internal.h"

namespace ossa::depth {

DepthStream::DepthStream(const Camera& camera, int fps, int max_value, bool mirrored)
    : camera_(camera), max_value_(max_value), mirrored_(mirrored) {
  mode_.pixelFormat = ONI_PIXEL_FORMAT_DEPTH_1_MM;
  mode_.resolutionX = camera.width;
  mode_.resolutionY = camera.height;
  mode_.fps = fps;
}

OniStatus DepthStream::getProperty(int id, void* data, int* size) {
  switch (id) {
    case ONI_STREAM_PROPERTY_VIDEO_MODE:
      return AnswerProperty(mode_, data, size);
    case ONI_STREAM_PROPERTY_HORIZONTAL_FOV:
      return AnswerProperty(static_cast<float>(2 * std::atan(camera_.width / (2 * camera_.fx))),
                            data, size);
    case ONI_STREAM_PROPERTY_VERTICAL_FOV:
      return AnswerProperty(static_cast<float>(2 * std::atan(camera_.height / (2 * camera_.fy))),
                            data, size);
    case ONI_STREAM_PROPERTY_MAX_VALUE:
      return AnswerProperty(max_value_, data, size);
    case ONI_STREAM_PROPERTY_MIN_VALUE:
      return AnswerProperty(int{0}, data, size);
    case ONI_STREAM_PROPERTY_STRIDE:
      return AnswerProperty(camera_.width * 2, data, size);
    case ONI_STREAM_PROPERTY_MIRRORING:
      return AnswerProperty(OniBool{mirrored_ ? TRUE : FALSE}, data, size);
    case ONI_STREAM_PROPERTY_CROPPING:  // without an answer, recordings play back no frame
      return AnswerProperty(OniCropping{FALSE, 0, 0, 0, 0}, data, size);
    case kCameraProperty:
      return AnswerProperty(std::array<double, 6>{static_cast<double>(camera_.width),
                                                  static_cast<double>(camera_.height), camera_.fx,
                                                  camera_.fy, camera_.cx, camera_.cy},
                            data, size);
    default:
      return ONI_STATUS_NOT_SUPPORTED;
  }
}

OniStatus DepthStream::setProperty(int id, const void* data, int size) {
  if (id == ONI_STREAM_PROPERTY_MIRRORING && size == static_cast<int>(sizeof(OniBool))) {
    mirrored_ = *static_cast<const OniBool*>(data) != FALSE;
    return ONI_STATUS_OK;
  }
  if (id == ONI_STREAM_PROPERTY_VIDEO_MODE && size == static_cast<int>(sizeof(OniVideoMode))) {
    const bool same = std::memcmp(data, &mode_, sizeof(mode_)) == 0;
    return same ? ONI_STATUS_OK : ONI_STATUS_NOT_SUPPORTED;
  }
  if (id == ONI_STREAM_PROPERTY_CROPPING && size == static_cast<int>(sizeof(OniCropping))) {
    const bool off = static_cast<const OniCropping*>(data)->enabled == FALSE;
    return off ? ONI_STATUS_OK : ONI_STATUS_NOT_SUPPORTED;
  }
  return ONI_STATUS_NOT_SUPPORTED;
}

OniBool DepthStream::isPropertySupported(int id) {
  switch (id) {
    case ONI_STREAM_PROPERTY_VIDEO_MODE:
    case ONI_STREAM_PROPERTY_HORIZONTAL_FOV:
    case ONI_STREAM_PROPERTY_VERTICAL_FOV:
    case ONI_STREAM_PROPERTY_MAX_VALUE:
    case ONI_STREAM_PROPERTY_MIN_VALUE:
    case ONI_STREAM_PROPERTY_STRIDE:
    case ONI_STREAM_PROPERTY_MIRRORING:
    case kCameraProperty:
      return TRUE;
    default:
      return FALSE;
  }
}

int DepthStream::getRequiredFrameSize() { return camera_.width * camera_.height * 2; }

void DepthStream::Deliver(const uint16_t* depth_mm, int frame_index, uint64_t timestamp_us) {
  OniFrame* frame = getServices().acquireFrame();
  if (frame == nullptr) return;
  const auto width = static_cast<size_t>(camera_.width);
  const auto height = static_cast<size_t>(camera_.height);
  auto* pixels = static_cast<uint16_t*>(frame->data);
  std::memcpy(pixels, depth_mm, width * height * sizeof(uint16_t));
  if (mirrored_) {
    for (size_t v = 0; v < height; ++v) {
      std::reverse(pixels + v * width, pixels + (v + 1) * width);
    }
  }
  frame->dataSize = getRequiredFrameSize();
  frame->frameIndex = frame_index;
  frame->timestamp = timestamp_us;
  frame->sensorType = ONI_SENSOR_DEPTH;
  frame->videoMode = mode_;
  frame->width = camera_.width;
  frame->height = camera_.height;
  frame->stride = camera_.width * 2;
  frame->croppingEnabled = FALSE;
  frame->cropOriginX = 0;
  frame->cropOriginY = 0;
  raiseNewFrame(frame);
  getServices().releaseFrame(frame);
}

}  // namespace ossa::depth
