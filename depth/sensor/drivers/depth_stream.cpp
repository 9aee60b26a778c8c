#include <algorithm>
#include <cmath>

#include "depth/sensor/drivers/camera_property_internal.h"
#include "depth/sensor/drivers/depth_stream_internal.h"

namespace ossa::depth {

OniVideoMode HalveMode(OniVideoMode mode) {
  mode.resolutionX /= 2;
  mode.resolutionY /= 2;
  return mode;
}

DepthStream::DepthStream(const Camera& camera, int fps, int max_value, bool mirrored,
                         bool offers_half)
    : camera_(camera), offers_half_(offers_half), max_value_(max_value), mirrored_(mirrored) {
  mode_.pixelFormat = ONI_PIXEL_FORMAT_DEPTH_1_MM;
  mode_.resolutionX = camera.width;
  mode_.resolutionY = camera.height;
  mode_.fps = fps;
}

OniStatus DepthStream::getProperty(int id, void* data, int* size) {
  const Camera camera = CurrentCamera();
  switch (id) {
    case ONI_STREAM_PROPERTY_VIDEO_MODE:
      return AnswerProperty(mode_, data, size);
    case ONI_STREAM_PROPERTY_HORIZONTAL_FOV:
      return AnswerProperty(static_cast<float>(2 * std::atan(camera.width / (2 * camera.fx))), data,
                            size);
    case ONI_STREAM_PROPERTY_VERTICAL_FOV:
      return AnswerProperty(static_cast<float>(2 * std::atan(camera.height / (2 * camera.fy))),
                            data, size);
    case ONI_STREAM_PROPERTY_MAX_VALUE:
      return AnswerProperty(max_value_, data, size);
    case ONI_STREAM_PROPERTY_MIN_VALUE:
      return AnswerProperty(int{0}, data, size);
    case ONI_STREAM_PROPERTY_STRIDE:
      return AnswerProperty(mode_.resolutionX * 2, data, size);
    case ONI_STREAM_PROPERTY_MIRRORING:
      return AnswerProperty(OniBool{mirrored_ ? TRUE : FALSE}, data, size);
    case ONI_STREAM_PROPERTY_CROPPING:  // recordings made from a stream without it play back no
                                        // frame
      return AnswerProperty(OniCropping{FALSE, 0, 0, 0, 0}, data, size);
    case kCameraProperty:
      return AnswerProperty(
          std::array<double, 6>{static_cast<double>(mode_.resolutionX),
                                static_cast<double>(mode_.resolutionY), camera.fx / step_,
                                camera.fy / step_, camera.cx / step_, camera.cy / step_},
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
    return SetVideoMode(*static_cast<const OniVideoMode*>(data));
  }
  if (id == ONI_STREAM_PROPERTY_CROPPING && size == static_cast<int>(sizeof(OniCropping))) {
    const bool off = static_cast<const OniCropping*>(data)->enabled == FALSE;
    return off ? ONI_STATUS_OK : ONI_STATUS_NOT_SUPPORTED;
  }
  return ONI_STATUS_NOT_SUPPORTED;
}

OniStatus DepthStream::SetVideoMode(const OniVideoMode& mode) {
  const auto is = [&](const OniVideoMode& other) {
    return std::memcmp(&mode, &other, sizeof(mode)) == 0;
  };
  if (is(mode_)) return ONI_STATUS_OK;
  OniVideoMode whole = mode_;
  whole.resolutionX = camera_.width;
  whole.resolutionY = camera_.height;
  const bool half = is(HalveMode(whole));
  if (!offers_half_ || (!half && !is(whole))) return ONI_STATUS_NOT_SUPPORTED;
  if (delivered_) return ONI_STATUS_OUT_OF_FLOW;
  mode_ = mode;
  step_ = half ? 2 : 1;
  raisePropertyChanged(ONI_STREAM_PROPERTY_VIDEO_MODE, &mode_, sizeof(mode_));
  return ONI_STATUS_OK;
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

int DepthStream::getRequiredFrameSize() { return mode_.resolutionX * mode_.resolutionY * 2; }

void DepthStream::Deliver(const uint16_t* depth_mm, int frame_index, uint64_t timestamp_us) {
  delivered_ = true;
  OniFrame* frame = getServices().acquireFrame();
  if (frame == nullptr) return;
  const auto width = static_cast<size_t>(mode_.resolutionX);
  const auto height = static_cast<size_t>(mode_.resolutionY);
  const auto step = static_cast<size_t>(step_);
  auto* pixels = static_cast<uint16_t*>(frame->data);
  for (size_t v = 0; v < height; ++v) {
    const uint16_t* row = depth_mm + v * step * static_cast<size_t>(camera_.width);
    for (size_t u = 0; u < width; ++u) pixels[v * width + u] = row[u * step];
  }
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
  frame->width = mode_.resolutionX;
  frame->height = mode_.resolutionY;
  frame->stride = mode_.resolutionX * 2;
  frame->croppingEnabled = FALSE;
  frame->cropOriginX = 0;
  frame->cropOriginY = 0;
  raiseNewFrame(frame);
  getServices().releaseFrame(frame);
}

}  // namespace ossa::depth
