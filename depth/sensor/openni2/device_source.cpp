#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <utility>

#include "depth/base/error.h"
#include "depth/image/camera_io.h"
#include "depth/sensor/drivers/camera_property_internal.h"
#include "depth/sensor/drivers/virtual_uri.h"
#include "depth/sensor/openni2/first_camera_internal.h"
#include "depth/sensor/openni2/lasting_thread.h"
#include "depth/sensor/openni2/openni_depth_internal.h"
#include "depth/sensor/sensor_clock.h"
#include "depth/sensor/source_internal.h"

namespace ossa::depth {
namespace {

using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;

// Length of one wait inside OpenNI2: a stream of an unplugged device only times out, so the flag
// must be polled between short waits.
constexpr milliseconds kSlice{100};

// Sets a flag when the device is unplugged. Called on a driver's thread, where nothing else is
// allowed, for any device of the process, including other cameras.
class UnplugFlag final : public openni::OpenNI::DeviceDisconnectedListener {
 public:
  UnplugFlag() { openni::OpenNI::addDeviceDisconnectedListener(this); }
  ~UnplugFlag() override { openni::OpenNI::removeDeviceDisconnectedListener(this); }

  void Watch(const std::string& uri) {
    const std::lock_guard lock(mutex_);
    uri_ = uri;
    set_ = false;
  }
  bool IsSet() const { return set_; }

 private:
  void onDeviceDisconnected(const openni::DeviceInfo* info) override {
    const std::lock_guard lock(mutex_);
    if (uri_ == info->getUri()) set_ = true;
  }
  std::mutex mutex_;  // guards uri_
  std::string uri_;
  std::atomic<bool> set_ = false;
};

// Our drivers provide the exact camera, others at least the field of view.
Camera ReadCamera(const openni::VideoStream& stream, int width, int height) {
  std::array<double, 6> exact{};
  int size = sizeof(exact);
  if (stream.isPropertySupported(kCameraProperty) &&
      stream.getProperty(kCameraProperty, exact.data(), &size) == openni::STATUS_OK) {
    const Camera camera{width, height, exact[2], exact[3], exact[4], exact[5]};
    if (IsSane(camera)) return camera;
  }
  return CameraFromFieldOfView(width, height, stream.getHorizontalFieldOfView(),
                               stream.getVerticalFieldOfView());
}

// OpenNI2 crashes on non-ASCII characters; our own scheme escapes them as %XX.
std::string AsciiUri(const std::string& uri) {
  std::string ascii;
  for (const char c : uri) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte >= 0x20 && byte < 0x7F) {
      ascii.push_back(c);
      continue;
    }
    if (!uri.starts_with(kVirtualScheme)) {
      throw InputError("openni:" + uri + ": expected a URI in ASCII: OpenNI2 takes no other");
    }
    constexpr std::string_view kDigits = "0123456789ABCDEF";
    ascii += {'%', kDigits[byte >> 4U], kDigits[byte & 15U]};
  }
  return ascii;
}

// OpenNI2 keeps only the newest frame of a stream, so a slow reader loses old frames and never
// falls behind; frame numbers show how many. Must be used on one thread only, a lasting one.
class Device {
 public:
  Device(std::string uri, const SourceOptions& options)
      : wanted_uri_(std::move(uri)), ascii_uri_(AsciiUri(wanted_uri_)), options_(options) {}
  ~Device() { Close(); }
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;

  ReadResult Read(milliseconds timeout) {
    const auto deadline = Clock::now() + timeout;
    if (!open_) return Reopen(deadline);
    do {
      openni::VideoStream* streams = &stream_;
      int ready = -1;
      const auto left = std::chrono::ceil<milliseconds>(deadline - Clock::now());
      const milliseconds slice = std::clamp(left, milliseconds{0}, kSlice);
      // A pending frame is delivered even if the device has just been unplugged.
      if (openni::OpenNI::waitForAnyStream(&streams, 1, &ready, static_cast<int>(slice.count())) ==
          openni::STATUS_OK) {
        return TakeFrame();
      }
      if (unplugged_.IsSet()) {
        Close();
        first_.Gone();
        return Result(ReadStatus::kDisconnected);
      }
    } while (Clock::now() < deadline);
    return Result(ReadStatus::kTimeout);
  }
  const Camera& camera() const { return camera_; }

  // Throws the error of TryOpen.
  [[noreturn]] void FailToOpen() const {
    const std::string name = "openni:" + wanted_uri_;
    if (wanted_uri_.empty() && ListDevices().empty()) {
      throw InputError(name + ": no OpenNI2 device found: plug one in, or name one as openni:URI");
    }
    throw InputError(name + ": cannot be opened: " + error_);
  }

  bool TryOpen() {
    const std::string uri = wanted_uri_.empty() ? first_.Find() : ascii_uri_;
    if (uri.empty()) return false;
    unplugged_.Watch(uri);
    if (device_.open(uri.c_str()) != openni::STATUS_OK ||
        stream_.create(device_, openni::SENSOR_DEPTH) != openni::STATUS_OK || !StartStream()) {
      error_ = OpenNiError();
      Close();
      return false;
    }
    open_ = true;
    if (wanted_uri_.empty() && uri != first_.uri()) BeginWith(uri);
    return true;
  }

 private:
  static ReadResult Result(ReadStatus status) { return {.status = status, .frame = {}}; }

  void BeginWith(const std::string& uri) {
    if (!first_.uri().empty() && options_.note) {
      options_.note(NoteKind::kInfo, "openni:: continues with " + uri +
                                         ", assumed to be the camera that was " + first_.uri());
    }
    first_.Opened(uri);
  }

  bool StartStream() {
    stream_.setMirroringEnabled(false);  // most drivers mirror by default; some cannot
    mirrored_ = stream_.getMirroringEnabled();
    const openni::VideoMode mode = stream_.getVideoMode();
    const int width = mode.getResolutionX();
    const int height = mode.getResolutionY();
    period_s_ = 1.0 / std::max(mode.getFps(), 1);
    whole_ = options_.camera ? ChosenCamera(options_, width, height)
                             : ReadCamera(stream_, width, height);
    camera_ = CropToWindow(whole_, ReadWindow(stream_, mirrored_));
    return stream_.start() == openni::STATUS_OK;
  }

  void Close() {
    stream_.stop();
    stream_.destroy();
    device_.close();
    open_ = false;
    after_gap_ = true;
  }

  ReadResult Reopen(Clock::time_point deadline) {
    do {
      if (TryOpen()) return Result(ReadStatus::kTimeout);  // reconnected: frames will follow
      std::this_thread::sleep_for(std::min<Clock::duration>(
          kSlice, std::max<Clock::duration>(deadline - Clock::now(), milliseconds{1})));
    } while (Clock::now() < deadline);
    return Result(ReadStatus::kDisconnected);
  }

  ReadResult TakeFrame() {
    openni::VideoFrameRef frame;
    if (stream_.readFrame(&frame) != openni::STATUS_OK || !frame.isValid()) {
      return Result(ReadStatus::kTimeout);
    }
    ReadResult result = Result(ReadStatus::kFrame);
    try {
      result.frame.depth_mm = ReadMillimetres(frame, mirrored_);
      result.frame.camera = CropToWindow(whole_, ReadWindow(frame, mirrored_));
    } catch (const InputError& error) {
      throw InputError("openni:" + wanted_uri_ + ": " + error.what());
    }
    const double sensor_s = static_cast<double>(frame.getTimestamp()) * 1e-6;
    if (last_index_ < 0) {
      clock_.SetTime(0.0, sensor_s);
    } else if (after_gap_) {
      result.dropped = CountGap(sensor_s);
    } else {
      result.dropped = std::max<int64_t>(frame.getFrameIndex() - last_device_index_ - 1, 0);
    }
    after_gap_ = false;
    last_device_index_ = frame.getFrameIndex();
    last_index_ += 1 + result.dropped;
    result.frame.index = last_index_;
    result.frame.time_s = last_time_s_ = clock_.TimeOf(sensor_s);
    last_frame_at_ = Clock::now();
    return result;
  }

  // After a reconnection the device's clock and frame numbers may restart: times continue by our
  // clock, and frames of the gap count as dropped.
  int64_t CountGap(double sensor_s) {
    const double gap_s = std::chrono::duration<double>(Clock::now() - last_frame_at_).count();
    clock_.SetTime(last_time_s_ + gap_s, sensor_s);
    return std::max<int64_t>(std::llround(gap_s / period_s_) - 1, 0);
  }

  OpenNiSession session_;  // first member: destroyed last
  UnplugFlag unplugged_;
  std::string wanted_uri_;
  std::string ascii_uri_;
  FirstCamera first_;  // if no URI was given
  SourceOptions options_;
  openni::Device device_;
  openni::VideoStream stream_;
  std::string error_ = "no reason given";
  Camera whole_;   // of the full image, of which frames may be a part
  Camera camera_;  // of the frames
  bool open_ = false;
  bool mirrored_ = false;
  bool after_gap_ = true;
  double period_s_ = 1.0 / 30.0;
  SensorClock clock_;
  double last_time_s_ = 0.0;
  int64_t last_index_ = -1;
  int64_t last_device_index_ = 0;
  Clock::time_point last_frame_at_;
};

class DeviceSource;

// The open sources. At program exit, drivers are destroyed before objects older than them, for
// instance a static one that holds a source; closing that source later would crash. Hence all
// sources are closed when exit begins.
class OpenDevices {
 public:
  static OpenDevices& Instance() {
    static auto* instance = new OpenDevices;  // never destroyed
    return *instance;
  }
  void Add(DeviceSource* source);
  void Remove(DeviceSource* source);

 private:
  static void EndAll();

  std::mutex mutex_;
  std::map<DeviceSource*, pid_t> sources_;  // with the process that opened them: not a child's
};

// A device that may be read from any thread of the program.
class DeviceSource final : public FrameSource {
 public:
  DeviceSource(const std::string& uri, const SourceOptions& options) {
    try {
      thread_->Run([&] { device_ = std::make_unique<Device>(uri, options); });
      OpenDevices::Instance().Add(this);
      Wait(options);
    } catch (...) {
      OpenDevices::Instance().Remove(this);
      End();
      throw;
    }
  }
  ~DeviceSource() override {
    OpenDevices::Instance().Remove(this);
    End();
  }
  DeviceSource(const DeviceSource&) = delete;
  DeviceSource& operator=(const DeviceSource&) = delete;

  ReadResult Read(milliseconds timeout) override {
    ReadResult read{.status = ReadStatus::kDisconnected, .frame = {}};
    thread_->Run([&] {
      if (device_) read = device_->Read(timeout);  // else the program is exiting
    });
    return read;
  }
  const Camera& camera() const override { return device_ ? device_->camera() : last_camera_; }
  bool is_live() const override { return true; }
  std::optional<int64_t> frame_count() const override { return std::nullopt; }

  void End() {
    thread_->Run([this] {
      if (device_) last_camera_ = device_->camera();
      device_.reset();
    });
  }

 private:
  // On this thread, because keep_waiting may check state of the calling thread, as Python's does
  // for Ctrl-C.
  void Wait(const SourceOptions& options) {
    const auto deadline = Clock::now() + options.device_wait;
    for (bool is_open = false;;) {
      thread_->Run([&] { is_open = device_->TryOpen(); });
      if (is_open) return;
      const bool go_on = !options.keep_waiting || options.keep_waiting();
      if (Clock::now() >= deadline || !go_on) thread_->Run([&] { device_->FailToOpen(); });
      std::this_thread::sleep_for(kSlice);
    }
  }

  BorrowedThread thread_;
  std::unique_ptr<Device> device_;  // none during program exit
  Camera last_camera_;
};

// Exit handlers run in reverse order of registration: registered for each source, because reloaded
// drivers are newer than earlier registrations.
void OpenDevices::Add(DeviceSource* source) {
  const std::lock_guard lock(mutex_);
  if (sources_.empty()) std::atexit(&EndAll);
  sources_[source] = getpid();
}

void OpenDevices::Remove(DeviceSource* source) {
  const std::lock_guard lock(mutex_);
  sources_.erase(source);
}

void OpenDevices::EndAll() {
  OpenDevices& all = Instance();
  const std::lock_guard lock(all.mutex_);
  for (const auto& [source, process] : all.sources_) {
    if (process == getpid()) source->End();
  }
}

}  // namespace

std::unique_ptr<FrameSource> OpenOpenNiDevice(const std::string& uri,
                                              const SourceOptions& options) {
  return std::make_unique<DeviceSource>(uri, options);
}

}  // namespace ossa::depth
