#include <algorithm>
#include <cmath>
#include <utility>

#include "depth/base/error.h"
#include "depth/image/camera.h"
#include "depth/sensor/openni2/delivered_depth.h"
#include "tools/nite2/depth_camera_internal.h"
#include "tools/nite2/frame_reader_internal.h"
#include "tools/nite2/oni_thread_internal.h"

namespace ossa::nite2 {
namespace {

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

bool ReadMirroring(OniStreamHandle stream) {
  OniBool mirrored = FALSE;
  int size = sizeof(mirrored);
  return oniStreamGetProperty(stream, ONI_STREAM_PROPERTY_MIRRORING, &mirrored, &size) ==
             ONI_STATUS_OK &&
         mirrored != FALSE;
}

// The pinhole camera of the frame's window, before mirroring.
depth::Camera MakeCamera(const DepthCamera::Geometry& geometry, const OniFrame& frame) {
  depth::Camera camera{frame.width,        frame.height,         geometry.focal_x(),
                       geometry.focal_y(), geometry.width / 2.0, geometry.height / 2.0};
  if (frame.croppingEnabled) {
    camera.cx -= frame.cropOriginX;
    camera.cy -= frame.cropOriginY;
  }
  if (geometry.mirrored) camera.cx = camera.width - camera.cx;
  return camera;
}

// Millimetres, row-major; mirrored rows are reversed.
std::vector<uint16_t> ReadMillimetres(const OniFrame& frame, bool mirrored) {
  const bool tenths = frame.videoMode.pixelFormat == ONI_PIXEL_FORMAT_DEPTH_100_UM;
  if (!tenths && frame.videoMode.pixelFormat != ONI_PIXEL_FORMAT_DEPTH_1_MM) {
    throw InputError("OpenNI2: expected depths in millimetres");
  }
  return depth::MillimetresOf(
      {frame.data, frame.width, frame.height, frame.stride, frame.dataSize, tenths, mirrored});
}

}  // namespace

OniFrameReleaser::OniFrameReleaser(const OniFrame& frame)
    : data_(frame.data),
      index_(frame.frameIndex),
      timestamp_us_(frame.timestamp),
      generation_(OniThread::Instance().generation()) {}

void OniFrameReleaser::operator()(OniFrame* frame) const {
  OniThread::Instance().Post([frame, self = *this] {
    if (self.generation_ != OniThread::Instance().generation()) return;
    const bool same = frame->data == self.data_ && frame->frameIndex == self.index_ &&
                      frame->timestamp == self.timestamp_us_;
    if (same) oniFrameRelease(frame);
  });
}

double DepthCamera::Geometry::focal_x() const { return width / (2 * std::tan(across_rad / 2)); }
double DepthCamera::Geometry::focal_y() const { return height / (2 * std::tan(down_rad / 2)); }

DepthCamera::DepthCamera(OniDeviceHandle device) {
  OniThread::Instance().Run([&] {
    try {
      Open(device);
    } catch (...) {
      Close();
      throw;
    }
  });
}

DepthCamera::~DepthCamera() {
  OniThread::Instance().Run([this] { Close(); });
}

void DepthCamera::Open(OniDeviceHandle device) {
  generation_ = OniThread::Instance().generation();
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
  device_callbacks_.deviceDisconnected = &DepthCamera::OnDisconnected;
  Require(oniRegisterDeviceCallbacks(&device_callbacks_, this, &device_callback_),
          "watching the device");
  Require(oniDeviceCreateStream(device_, ONI_SENSOR_DEPTH, &stream_), "opening its depth stream");
  ReadGeometry();
  Require(oniStreamStart(stream_), "starting its depth stream");
}

void DepthCamera::Close() {
  if (generation_ != OniThread::Instance().generation()) return;
  RemoveFrameCallback();
  if (stream_ != nullptr) {
    oniStreamStop(stream_);
    oniStreamDestroy(stream_);
  }
  if (device_callback_ != nullptr) oniUnregisterDeviceCallbacks(device_callback_);
  if (device_ != nullptr) oniDeviceClose(device_);
}

void ONI_CALLBACK_TYPE DepthCamera::OnDisconnected(const OniDeviceInfo* info, void* camera) {
  auto* self = static_cast<DepthCamera*>(camera);
  if (self->uri_ == info->uri) self->gone_ = true;
}

void ONI_CALLBACK_TYPE DepthCamera::OnFrame(OniStreamHandle, void* camera) {
  auto* self = static_cast<DepthCamera*>(camera);
  const DepthCamera* outer = std::exchange(in_call_of, self);
  self->on_frame_();
  in_call_of = outer;
}

bool DepthCamera::IsInCallback() const { return in_call_of == this; }

void DepthCamera::ReadGeometry() {
  constexpr float kLeast_rad = 0.01F, kMost_rad = 3.1F;  // by hand: bounds of a field of view
  OniVideoMode mode{};
  int size = sizeof(mode);
  Require(oniStreamGetProperty(stream_, ONI_STREAM_PROPERTY_VIDEO_MODE, &mode, &size),
          "asking for the video mode");
  Geometry seen{mode.resolutionX, mode.resolutionY,
                FieldOfView(stream_, ONI_STREAM_PROPERTY_HORIZONTAL_FOV),
                FieldOfView(stream_, ONI_STREAM_PROPERTY_VERTICAL_FOV), ReadMirroring(stream_)};
  if (std::min(seen.across_rad, seen.down_rad) < kLeast_rad ||
      std::max(seen.across_rad, seen.down_rad) > kMost_rad) {
    const depth::Camera kinect = depth::KinectV1Camera(seen.width, seen.height);
    seen.across_rad = 2 * std::atan(kinect.width / (2 * kinect.fx));
    seen.down_rad = 2 * std::atan(kinect.height / (2 * kinect.fy));
  }
  const std::lock_guard lock(looking_);
  geometry_ = seen;
}

DepthCamera::Geometry DepthCamera::geometry() const {
  const std::lock_guard lock(looking_);
  return geometry_;
}

std::optional<CameraFrame> DepthCamera::Next(std::chrono::milliseconds timeout) {
  bool known = true;
  OniFrame* delivered = FrameReader::Instance().Read(stream_, timeout, [&] {
    try {
      ReadGeometry();
    } catch (const InputError&) {
      known = false;
    }
  });
  if (delivered == nullptr) return std::nullopt;
  CameraFrame frame;
  frame.delivered = OniFramePtr(delivered, OniFrameReleaser(*delivered));
  if (!known) throw InputError("OpenNI2: a stream that does not know its video mode");
  const Geometry seen = geometry();
  frame.mirrored = seen.mirrored;
  frame.image.depth_mm = ReadMillimetres(*delivered, seen.mirrored);
  frame.image.camera = MakeCamera(seen, *delivered);
  frame.image.time_s = clock_.TimeOf(delivered->timestamp);
  frame.image.index = frames_++;
  return frame;
}

void DepthCamera::SetFrameCallback(std::function<void()> on_frame) {
  RemoveFrameCallback();
  on_frame_ = std::move(on_frame);
  OniThread::Instance().Run([this] {
    Require(
        oniStreamRegisterNewFrameCallback(stream_, &DepthCamera::OnFrame, this, &frame_callback_),
        "asking to be told of frames");
  });
}

void DepthCamera::RemoveFrameCallback() {
  if (IsInCallback()) return;
  OniThread::Instance().Run([this] {
    if (frame_callback_ == nullptr) return;
    oniStreamUnregisterNewFrameCallback(stream_, frame_callback_);
    frame_callback_ = nullptr;
  });
}

}  // namespace ossa::nite2
