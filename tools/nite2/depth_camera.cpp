#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

#include "depth/base/error.h"
#include "depth/image/camera.h"
#include "tools/nite2/depth_camera_internal.h"

namespace ossa::nite2 {
namespace {

constexpr double kMicrosecond = 1e-6;  // in seconds; by definition

thread_local const DepthCamera* in_call_of = nullptr;

void Require(OniStatus status, const std::string& what) {
  if (status != ONI_STATUS_OK) throw InputError("OpenNI2: " + what + " failed");
}

float FieldOfView(OniStreamHandle stream, int property) {
  float angle_rad = 0.0F;
  int size = sizeof(angle_rad);
  return oniStreamGetProperty(stream, property, &angle_rad, &size) == ONI_STATUS_OK ? angle_rad
                                                                                    : 0.0F;
}

// The pinhole camera that OpenNI2's own conversions use, of the window that the frame shows and as
// it is before mirroring.
depth::Camera CameraOf(OniStreamHandle stream, const OniFrame& frame, bool mirrored) {
  constexpr float kLeast_rad = 0.01F, kMost_rad = 3.1F;  // by hand: a field of view at all
  const float across = FieldOfView(stream, ONI_STREAM_PROPERTY_HORIZONTAL_FOV);
  const float down = FieldOfView(stream, ONI_STREAM_PROPERTY_VERTICAL_FOV);
  const int width = frame.videoMode.resolutionX, height = frame.videoMode.resolutionY;
  depth::Camera camera = depth::KinectV1Camera(width, height);
  if (std::min(across, down) > kLeast_rad && std::max(across, down) < kMost_rad) {
    camera = {width,
              height,
              width / (2 * std::tan(across / 2.0)),
              height / (2 * std::tan(down / 2.0)),
              width / 2.0,
              height / 2.0};
  }
  if (frame.croppingEnabled) {
    camera.cx -= frame.cropOriginX;
    camera.cy -= frame.cropOriginY;
  }
  camera.width = frame.width;
  camera.height = frame.height;
  if (mirrored) camera.cx = camera.width - camera.cx;
  return camera;
}

// Millimetres, row by row, turned back where they are mirrored.
std::vector<uint16_t> MillimetresOf(const OniFrame& frame, bool mirrored) {
  const bool tenths = frame.videoMode.pixelFormat == ONI_PIXEL_FORMAT_DEPTH_100_UM;
  if (!tenths && frame.videoMode.pixelFormat != ONI_PIXEL_FORMAT_DEPTH_1_MM) {
    throw InputError("OpenNI2: expected depths in millimetres");
  }
  const bool whole = frame.width > 0 && frame.height > 0 && frame.stride >= 2 * frame.width &&
                     int64_t{frame.stride} * (frame.height - 1) + 2 * frame.width <= frame.dataSize;
  if (!whole) throw InputError("OpenNI2: a depth frame that is cut short");
  const auto width = static_cast<size_t>(frame.width);
  std::vector<uint16_t> depth_mm(width * static_cast<size_t>(frame.height));
  for (int v = 0; v < frame.height; ++v) {
    uint16_t* row = depth_mm.data() + static_cast<ptrdiff_t>(v) * frame.width;
    std::memcpy(row, static_cast<const char*>(frame.data) + ptrdiff_t{frame.stride} * v, 2 * width);
    if (tenths) {
      std::transform(row, row + width, row,
                     [](uint16_t d) { return static_cast<uint16_t>((d + 5) / 10); });
    }
    if (mirrored) std::reverse(row, row + width);
  }
  return depth_mm;
}

}  // namespace

DepthCamera::DepthCamera(OniDeviceHandle device) {
  try {
    Open(device);
  } catch (...) {
    Close();
    throw;
  }
}

DepthCamera::~DepthCamera() { Close(); }

void DepthCamera::Open(OniDeviceHandle device) {
  if (device == nullptr) {
    Require(oniDeviceOpen(nullptr, &device_), "opening a device");
  } else {
    OniDeviceInfo info{};
    Require(oniDeviceGetInfo(device, &info), "asking for the device");
    Require(oniDeviceOpen(info.uri, &device_), "opening the device again");
  }
  OniDeviceInfo info{};
  Require(oniDeviceGetInfo(device_, &info), "asking for the device");
  uri_ = info.uri;
  device_callbacks_.deviceDisconnected = &DepthCamera::OnGone;
  Require(oniRegisterDeviceCallbacks(&device_callbacks_, this, &device_callback_),
          "watching the device");
  Require(oniDeviceCreateStream(device_, ONI_SENSOR_DEPTH, &stream_), "opening its depth stream");
  Require(oniStreamStart(stream_), "starting its depth stream");
}

void DepthCamera::Close() {
  StopTelling();
  if (stream_ != nullptr) {
    oniStreamStop(stream_);
    oniStreamDestroy(stream_);
  }
  if (device_callback_ != nullptr) oniUnregisterDeviceCallbacks(device_callback_);
  if (device_ != nullptr) oniDeviceClose(device_);
}

void ONI_CALLBACK_TYPE DepthCamera::OnGone(const OniDeviceInfo* info, void* camera) {
  auto* self = static_cast<DepthCamera*>(camera);
  if (self->uri_ == info->uri) self->gone_ = true;
}

void ONI_CALLBACK_TYPE DepthCamera::OnFrame(OniStreamHandle, void* camera) {
  auto* self = static_cast<DepthCamera*>(camera);
  const DepthCamera* outer = std::exchange(in_call_of, self);
  self->on_frame_();
  in_call_of = outer;
}

bool DepthCamera::InCall() const { return in_call_of == this; }

WaitResult DepthCamera::Wait(std::chrono::milliseconds timeout) {
  OniStreamHandle streams[] = {stream_};
  int ready = -1;
  // A frame that is there is given even when the device has just gone.
  const OniStatus status =
      oniWaitForAnyStream(streams, 1, &ready, static_cast<int>(timeout.count()));
  if (status == ONI_STATUS_OK) return WaitResult::kFrame;
  return gone_ ? WaitResult::kGone : WaitResult::kTimeout;
}

bool DepthCamera::IsMirrored() const {
  OniBool mirrored = FALSE;
  int size = sizeof(mirrored);
  const OniStatus status =
      oniStreamGetProperty(stream_, ONI_STREAM_PROPERTY_MIRRORING, &mirrored, &size);
  return status == ONI_STATUS_OK && mirrored != FALSE;
}

// Seconds that never run backwards, as those of a recording do that begins anew.
double DepthCamera::TimeOf(const OniFrame& frame) {
  constexpr double kPeriod_s = 1.0 / 30.0;  // of the usual camera
  const double sensor_s = static_cast<double>(frame.timestamp) * kMicrosecond;
  if (frames_ > 0 && frame.timestamp < last_us_) {
    offset_s_ += static_cast<double>(last_us_ - frame.timestamp) * kMicrosecond + kPeriod_s;
  }
  last_us_ = frame.timestamp;
  return sensor_s + offset_s_;
}

CameraFrame DepthCamera::Read() {
  OniFrame* delivered = nullptr;
  Require(oniStreamReadFrame(stream_, &delivered), "reading a frame");
  CameraFrame frame;
  frame.delivered.reset(delivered);
  frame.mirrored = IsMirrored();
  frame.image.depth_mm = MillimetresOf(*delivered, frame.mirrored);
  frame.image.camera = CameraOf(stream_, *delivered, frame.mirrored);
  frame.image.time_s = TimeOf(*delivered);
  frame.image.index = frames_++;
  return frame;
}

void DepthCamera::TellOfFrames(std::function<void()> on_frame) {
  StopTelling();
  on_frame_ = std::move(on_frame);
  Require(oniStreamRegisterNewFrameCallback(stream_, &DepthCamera::OnFrame, this, &frame_callback_),
          "asking to be told of frames");
}

void DepthCamera::StopTelling() {
  if (frame_callback_ == nullptr || InCall()) return;
  oniStreamUnregisterNewFrameCallback(stream_, frame_callback_);
  frame_callback_ = nullptr;
}

bool DepthCamera::ToPixel(float x, float y, float z, float* pixel_x, float* pixel_y) const {
  float depth = 0.0F;
  return z > 0.0F && oniCoordinateConverterWorldToDepth(stream_, x, y, z, pixel_x, pixel_y,
                                                        &depth) == ONI_STATUS_OK;
}

bool DepthCamera::ToPoint(int pixel_x, int pixel_y, int z, float* x, float* y) const {
  float depth = 0.0F;
  return oniCoordinateConverterDepthToWorld(stream_, static_cast<float>(pixel_x),
                                            static_cast<float>(pixel_y), static_cast<float>(z), x,
                                            y, &depth) == ONI_STATUS_OK;
}

}  // namespace ossa::nite2
