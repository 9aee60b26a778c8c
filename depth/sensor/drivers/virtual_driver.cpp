// libossa_virtual.so.0: an OpenNI2 driver module that plays a recording as a live depth camera, for
// testing without hardware, in ossa and in any OpenNI2 program.
#include <algorithm>
#include <array>
#include <condition_variable>
#include <cstdlib>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

#include "depth/base/error.h"
#include "depth/sensor/drivers/depth_stream_internal.h"
#include "depth/sensor/drivers/event_queue_internal.h"
#include "depth/sensor/drivers/virtual_uri.h"
#include "depth/sensor/frame_source.h"

namespace ossa::depth {
namespace {

using Clock = std::chrono::steady_clock;
using Seconds = std::chrono::duration<double>;

// Above all depths that OniRecorder accepts; OpenNI2's bound
constexpr int kMaxValue = 65535;

// Exists independently of open devices: playback continues while the camera is unplugged.
class VirtualCamera {
 public:
  VirtualCamera(const std::string& uri, const VirtualDeviceOptions& options)
      : options_(options), source_(Open()), camera_(source_->camera()) {
    CopyName(uri, info_.uri);
    CopyName("ossa", info_.vendor);
    CopyName("virtual depth camera", info_.name);
  }

  const OniDeviceInfo& info() const { return info_; }
  const VirtualDeviceOptions& options() const { return options_; }
  const Camera& camera() const { return camera_; }  // of its streams, whatever is played later
  int fps() const { return std::max(1, static_cast<int>(options_.fps.value_or(30.0))); }

  struct Frame {
    DepthFrame image;
    int index = 0;
    Seconds due{0};  // since playback started
  };

  // The next frame, or none at the end. Unreadable frames and frames of another size than the
  // streams are dropped: their index is missing, as with a camera.
  std::optional<Frame> Next() {
    for (bool restarted = false;;) {
      try {
        ReadResult result = source_->Read(std::chrono::milliseconds(1000));
        index_ += static_cast<int>(result.dropped);
        if (result.status == ReadStatus::kFrame) {
          CheckSize(result.frame.camera);
          return Timed(std::move(result.frame));
        }
        if (result.status == ReadStatus::kTimeout) continue;
        if (!options_.loop || restarted) return std::nullopt;
        restarted = true;
        source_ = Open();
        first_time_s_.reset();
        loop_began_ = next_due_;
      } catch (const InputError&) {
        ++index_;
        if (!std::exchange(failed_, true)) continue;
        return std::nullopt;  // two failures in a row
      }
    }
  }

  // Due time of the first frame; the clock starts at the first call. Not immediately: OpenNI2
  // discards frames that arrive before start() has returned.
  Clock::time_point Began() {
    constexpr std::chrono::milliseconds kStartUp{40};
    if (!began_) began_ = Clock::now() + kStartUp;
    return *began_;
  }

  // Guarded by the driver's mutex.
  bool plugged = true;
  int unplugs_left = 0;

 private:
  std::unique_ptr<FrameSource> Open() const {
    return OpenSource(options_.path, {.mirrored = options_.mirrored});
  }

  void CheckSize(const Camera& camera) const {
    if (camera.width != camera_.width || camera.height != camera_.height) {
      throw InputError(options_.path + ": a frame of another size than the first");
    }
  }

  Frame Timed(DepthFrame image) {
    failed_ = false;
    const double period_s = 1.0 / options_.fps.value_or(30.0);
    if (!first_time_s_) first_time_s_ = image.time_s;
    const Seconds at{options_.fps ? index_ * period_s : image.time_s - *first_time_s_};
    const Seconds due = options_.fps ? at : loop_began_ + at;
    next_due_ = due + Seconds(period_s);
    return {std::move(image), index_++, due / options_.speed};
  }

  OniDeviceInfo info_{};
  VirtualDeviceOptions options_;
  std::unique_ptr<FrameSource> source_;
  const Camera camera_;
  std::optional<Clock::time_point> began_;
  int index_ = 0;
  bool failed_ = false;
  // First time stamp of the recording; in a ROS bag it may count from 1970.
  std::optional<double> first_time_s_;
  Seconds loop_began_{0};
  Seconds next_due_{0};
};

// Callbacks from streams to the driver.
class UnplugHandler {
 public:
  virtual ~UnplugHandler() = default;
  virtual void Unplug(VirtualCamera& camera, bool comes_back) = 0;
};

// Whether the size can be halved.
bool IsEven(const Camera& camera) { return camera.width % 2 == 0 && camera.height % 2 == 0; }

class VirtualStream final : public DepthStream {
 public:
  VirtualStream(VirtualCamera& camera, UnplugHandler& driver)
      : DepthStream(camera.camera(), camera.fps(), kMaxValue, camera.options().mirror,
                    IsEven(camera.camera())),
        camera_(camera),
        driver_(driver) {}
  ~VirtualStream() override { stop(); }

  OniStatus start() override {
    stop();
    stopping_ = false;
    thread_ = std::thread([this] { Play(); });
    return ONI_STATUS_OK;
  }

  void stop() override {
    {
      const std::lock_guard lock(mutex_);
      stopping_ = true;
    }
    wake_.notify_all();
    if (thread_.joinable()) thread_.join();
  }

 private:
  bool WaitUntil(Clock::time_point when) {
    std::unique_lock lock(mutex_);
    return !wake_.wait_until(lock, when, [this] { return stopping_; });
  }

  void Play() {
    const Clock::time_point began = camera_.Began();
    const auto& options = camera_.options();
    // Frames later than this are dropped, as with a camera: after a replug, or if the machine
    // stalled. One per second is still delivered: otherwise a machine too slow to decode would get
    // none.
    constexpr std::chrono::seconds kLongestSilence{1};
    auto silent_since = Clock::now();
    const Seconds lateness{2.0 / camera_.fps() / options.speed};
    uint64_t clock_began_us = 0;
    for (int delivered = 0;;) {
      const auto frame = camera_.Next();
      if (!frame) return driver_.Unplug(camera_, false);
      const auto due = began + std::chrono::duration_cast<Clock::duration>(frame->due);
      const auto now = Clock::now();
      if (now - due > lateness && now - silent_since < kLongestSilence) {
        if (!WaitUntil(now)) return;
        continue;
      }
      if (!WaitUntil(due)) return;
      const auto due_us =
          static_cast<uint64_t>(std::chrono::duration<double, std::micro>(frame->due).count());
      if (delivered == options.restart_clock_after) clock_began_us = due_us;
      Deliver(frame->image.depth_mm.data(), frame->index, due_us - clock_began_us);
      ++delivered;
      silent_since = Clock::now();
      if (options.stall_after && delivered >= *options.stall_after) {
        WaitUntil(Clock::now() + std::chrono::hours(24 * 365));
        return;
      }
      if (options.unplug_after && delivered == *options.unplug_after && camera_.unplugs_left > 0) {
        return driver_.Unplug(camera_, options.replug_after.count() > 0);
      }
    }
  }

  VirtualCamera& camera_;
  UnplugHandler& driver_;
  std::thread thread_;
  std::mutex mutex_;
  std::condition_variable wake_;
  bool stopping_ = false;
};

class VirtualDevice final : public oni::driver::DeviceBase {
 public:
  VirtualDevice(VirtualCamera& camera, UnplugHandler& driver) : camera_(camera), driver_(driver) {
    modes_[0] = {ONI_PIXEL_FORMAT_DEPTH_1_MM, camera.camera().width, camera.camera().height,
                 camera.fps()};
    modes_[1] = HalveMode(modes_[0]);
    sensor_ = {ONI_SENSOR_DEPTH, IsEven(camera.camera()) ? 2 : 1, modes_.data()};
  }

  OniStatus getSensorInfoList(OniSensorInfo** sensors, int* count) override {
    *sensors = &sensor_;
    *count = 1;
    return ONI_STATUS_OK;
  }
  oni::driver::StreamBase* createStream(OniSensorType type) override {
    return type == ONI_SENSOR_DEPTH ? new VirtualStream(camera_, driver_) : nullptr;
  }
  void destroyStream(oni::driver::StreamBase* stream) override { delete stream; }

  OniStatus getProperty(int id, void* data, int* size) override {
    if (id != ONI_DEVICE_PROPERTY_DRIVER_VERSION) return ONI_STATUS_NOT_SUPPORTED;
    return AnswerProperty(OniVersion{0, 1, 0, 0}, data, size);
  }
  OniBool isPropertySupported(int id) override {
    return id == ONI_DEVICE_PROPERTY_DRIVER_VERSION ? TRUE : FALSE;
  }

 private:
  VirtualCamera& camera_;
  UnplugHandler& driver_;
  std::array<OniVideoMode, 2> modes_{};
  OniSensorInfo sensor_{};
};

// Makes the path absolute, relative to the shell's folder.
std::string AbsoluteUri(const std::string& uri) {
  const size_t scheme = std::strlen(kVirtualScheme);
  const char* folder = std::getenv("PWD");
  const bool is_relative =
      uri.starts_with(kVirtualScheme) && uri.size() > scheme && uri[scheme] != '/';
  if (!is_relative || folder == nullptr) return uri;
  return kVirtualScheme + (std::string(folder) + "/" + uri.substr(scheme));
}

class VirtualDriver final : public oni::driver::DriverBase, public UnplugHandler {
 public:
  explicit VirtualDriver(OniDriverServices* services) : DriverBase(services) {}

  // OSSA_VIRTUAL_DEVICE=ossa://PATH is connected from the start, so "any device" finds it. OpenNI2
  // has changed the working directory to its drivers' by now; the shell's PWD still has the
  // original one.
  OniStatus initialize(oni::driver::DeviceConnectedCallback connected,
                       oni::driver::DeviceDisconnectedCallback disconnected,
                       oni::driver::DeviceStateChangedCallback changed, void* cookie) override {
    DriverBase::initialize(connected, disconnected, changed, cookie);
    events_ = std::make_unique<EventQueue>();
    const char* uri = std::getenv("OSSA_VIRTUAL_DEVICE");
    if (uri != nullptr && *uri != '\0') tryDevice(AbsoluteUri(uri).c_str());
    return ONI_STATUS_OK;
  }

  OniStatus tryDevice(const char* uri) override {
    if (std::strncmp(uri, kVirtualScheme, std::strlen(kVirtualScheme)) != 0) {
      return ONI_STATUS_ERROR;
    }
    try {
      if (std::strlen(uri) >= ONI_MAX_STR) {
        throw InputError(std::string(uri) + ": expected fewer than 256 characters");
      }
      const VirtualCamera* camera = PluggedCamera(uri);
      if (camera == nullptr) return ONI_STATUS_ERROR;
      deviceConnected(&camera->info());  // without our lock: OpenNI2 takes its own
      return ONI_STATUS_OK;
    } catch (const std::exception& error) {
      getServices().errorLoggerAppend("%s", error.what());
      return ONI_STATUS_ERROR;
    }
  }

  oni::driver::DeviceBase* deviceOpen(const char* uri, const char*) override {
    const std::lock_guard lock(mutex_);
    const auto found = cameras_.find(uri);
    if (found == cameras_.end() || !found->second) return nullptr;
    return new VirtualDevice(*found->second, *this);
  }
  void deviceClose(oni::driver::DeviceBase* device) override { delete device; }

  void shutdown() override {
    events_.reset();
    cameras_.clear();
  }

  void Unplug(VirtualCamera& camera, bool comes_back) override {
    {
      const std::lock_guard lock(mutex_);
      camera.plugged = false;
      --camera.unplugs_left;
    }
    events_->Now([this, &camera] { deviceDisconnected(&camera.info()); });
    if (!comes_back) return;
    events_->At(Clock::now() + camera.options().replug_after, [this, &camera] {
      {
        const std::lock_guard lock(mutex_);
        camera.plugged = true;
      }
      deviceConnected(&camera.info());
    });
  }

 private:
  // Created at first use; none while it is unplugged.
  const VirtualCamera* PluggedCamera(const char* uri) {
    const std::lock_guard lock(mutex_);
    std::unique_ptr<VirtualCamera>& camera = cameras_[uri];
    if (!camera) {
      camera = std::make_unique<VirtualCamera>(uri, ParseVirtualUri(uri));
      camera->unplugs_left = camera->options().unplugs;
    }
    return camera->plugged ? camera.get() : nullptr;
  }

  std::mutex mutex_;
  std::map<std::string, std::unique_ptr<VirtualCamera>, std::less<>> cameras_;
  std::unique_ptr<EventQueue> events_;
};

}  // namespace
}  // namespace ossa::depth

ONI_EXPORT_DRIVER(ossa::depth::VirtualDriver)
