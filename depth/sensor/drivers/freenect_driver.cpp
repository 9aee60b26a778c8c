// libossa_freenect.so.0: an OpenNI2 driver module for the Kinect v1 (Xbox 360, Kinect for Windows)
// over libfreenect. Debian's OpenNI2 has none. Devices are freenect://SERIAL, or freenect://INDEX
// where libfreenect knows no serial numbers (fakenect).
#include <dlfcn.h>
#include <sys/time.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cstdlib>
#include <utility>

#include "depth/sensor/drivers/depth_stream_internal.h"
#include "depth/sensor/drivers/event_queue_internal.h"
#include "depth/sensor/drivers/freenect_camera_internal.h"
#include "depth/sensor/drivers/kinect_properties.h"

namespace ossa::depth {
namespace {

constexpr int kMaxValue = 10001;  // libfreenect's depths end at 10 m

// The depth camera: libfreenect's zero plane (1200 mm) over twice the width of a pixel on it (1.042
// mm). The registered view: libfreenect's registration for a Kinect without its own
// (src/registration.c) scales that image by 0.926 and shifts its centre.
Camera KinectCamera(KinectDepthMode mode) {
  if (mode == KinectDepthMode::kRegistered) return {640, 480, 533.0, 533.0, 304.0, 253.0};
  return {640, 480, 575.8, 575.8, 320.0, 240.0};
}

// OSSA_FREENECT_DEPTH = mm (default), registered or raw. Registration is not needed here, as
// colours are not used, and leaves holes that the models were not trained on.
KinectDepthMode ModeFromEnvironment() {
  const char* chosen = std::getenv("OSSA_FREENECT_DEPTH");
  const std::string name = chosen != nullptr ? chosen : "mm";
  if (name == "registered") return KinectDepthMode::kRegistered;
  return name == "raw" ? KinectDepthMode::kRaw : KinectDepthMode::kMillimetres;
}

class KinectStream final : public DepthStream {
 public:
  explicit KinectStream(FreenectCamera& camera)
      : DepthStream(KinectCamera(camera.mode()), 30, kMaxValue, false), camera_(camera) {}
  ~KinectStream() override { stop(); }

  OniStatus start() override {
    if (!camera_.Start()) return ONI_STATUS_ERROR;
    // On its own thread: OpenNI2's locks must not be taken under libfreenect's.
    thread_ = std::thread([this] {
      for (KinectFrame frame; camera_.Fetch(&frame);) {
        Deliver(frame.depth_mm.data(), frame.index, frame.timestamp_us);
      }
    });
    return ONI_STATUS_OK;
  }
  void stop() override {
    camera_.Stop();
    if (thread_.joinable()) thread_.join();
  }

 protected:
  Camera CurrentCamera() const override { return KinectCamera(camera_.mode()); }

 private:
  FreenectCamera& camera_;
  std::thread thread_;
};

class KinectDevice final : public oni::driver::DeviceBase {
 public:
  KinectDevice(std::unique_ptr<FreenectCamera> camera, std::string serial)
      : camera_(std::move(camera)), serial_(std::move(serial)) {
    mode_ = {ONI_PIXEL_FORMAT_DEPTH_1_MM, 640, 480, 30};
    sensor_ = {ONI_SENSOR_DEPTH, 1, &mode_};
  }

  OniStatus getSensorInfoList(OniSensorInfo** sensors, int* count) override {
    *sensors = &sensor_;
    *count = 1;
    return ONI_STATUS_OK;
  }
  oni::driver::StreamBase* createStream(OniSensorType type) override {
    return type == ONI_SENSOR_DEPTH ? new KinectStream(*camera_) : nullptr;
  }
  void destroyStream(oni::driver::StreamBase* stream) override { delete stream; }

  OniStatus getProperty(int id, void* data, int* size) override {
    switch (id) {
      case ONI_DEVICE_PROPERTY_DRIVER_VERSION:
        return AnswerProperty(OniVersion{0, 1, 0, 0}, data, size);
      case ONI_DEVICE_PROPERTY_SERIAL_NUMBER:
        if (*size <= static_cast<int>(serial_.size())) return ONI_STATUS_BAD_PARAMETER;
        std::memcpy(data, serial_.c_str(), serial_.size() + 1);
        *size = static_cast<int>(serial_.size()) + 1;
        return ONI_STATUS_OK;
      case ONI_DEVICE_PROPERTY_IMAGE_REGISTRATION:
        return AnswerProperty(camera_->mode() == KinectDepthMode::kRegistered
                                  ? ONI_IMAGE_REGISTRATION_DEPTH_TO_COLOR
                                  : ONI_IMAGE_REGISTRATION_OFF,
                              data, size);
      case kKinectTiltProperty: {
        double tilt_deg = 0.0;
        return camera_->GetTilt_deg(&tilt_deg) ? AnswerProperty(tilt_deg, data, size)
                                               : ONI_STATUS_ERROR;
      }
      case kKinectAccelProperty: {
        std::array<double, 3> xyz_mps2{};
        return camera_->GetAcceleration(xyz_mps2.data()) ? AnswerProperty(xyz_mps2, data, size)
                                                         : ONI_STATUS_ERROR;
      }
      default:
        return ONI_STATUS_NOT_SUPPORTED;
    }
  }

  OniStatus setProperty(int id, const void* data, int size) override {
    if (id == kKinectTiltProperty && size == static_cast<int>(sizeof(double))) {
      double tilt_deg = 0.0;
      std::memcpy(&tilt_deg, data, sizeof(tilt_deg));
      return camera_->SetTilt_deg(tilt_deg) ? ONI_STATUS_OK : ONI_STATUS_BAD_PARAMETER;
    }
    if (id == ONI_DEVICE_PROPERTY_IMAGE_REGISTRATION &&
        size == static_cast<int>(sizeof(OniImageRegistrationMode))) {
      const bool on = *static_cast<const OniImageRegistrationMode*>(data) ==
                      ONI_IMAGE_REGISTRATION_DEPTH_TO_COLOR;
      return camera_->SetMode(on ? KinectDepthMode::kRegistered : KinectDepthMode::kMillimetres)
                 ? ONI_STATUS_OK
                 : ONI_STATUS_OUT_OF_FLOW;
    }
    return ONI_STATUS_NOT_SUPPORTED;
  }

  OniBool isPropertySupported(int id) override {
    return id == ONI_DEVICE_PROPERTY_DRIVER_VERSION || id == ONI_DEVICE_PROPERTY_SERIAL_NUMBER ||
                   id == ONI_DEVICE_PROPERTY_IMAGE_REGISTRATION || id == kKinectTiltProperty ||
                   id == kKinectAccelProperty
               ? TRUE
               : FALSE;
  }
  OniBool isImageRegistrationModeSupported(OniImageRegistrationMode) override { return TRUE; }

 private:
  std::unique_ptr<FreenectCamera> camera_;
  std::string serial_;
  OniVideoMode mode_{};
  OniSensorInfo sensor_{};
};

// Serial numbers in libfreenect's order; indices if it knows none. Debian's fakenect lacks the
// listing functions, so they are looked up at run time instead of linked.
std::vector<std::string> SerialNumbers(freenect_context* context) {
  using List = int (*)(freenect_context*, freenect_device_attributes**);
  using Free = void (*)(freenect_device_attributes*);
  const auto list = reinterpret_cast<List>(dlsym(RTLD_DEFAULT, "freenect_list_device_attributes"));
  const auto free = reinterpret_cast<Free>(dlsym(RTLD_DEFAULT, "freenect_free_device_attributes"));
  std::vector<std::string> serials;
  const int count = freenect_num_devices(context);
  freenect_device_attributes* attributes = nullptr;
  const freenect_device_attributes* at = nullptr;
  if (count > 0 && list != nullptr && free != nullptr && list(context, &attributes) >= 0) {
    at = attributes;
  }
  for (int i = 0; i < count; ++i) {
    const bool known = at != nullptr && at->camera_serial != nullptr && *at->camera_serial != '\0';
    serials.push_back(known ? at->camera_serial : std::to_string(i));
    if (at != nullptr) at = at->next;
  }
  if (attributes != nullptr) free(attributes);
  return serials;
}

class FreenectDriver final : public oni::driver::DriverBase {
 public:
  explicit FreenectDriver(OniDriverServices* services) : DriverBase(services) {}

  OniStatus initialize(oni::driver::DeviceConnectedCallback connected,
                       oni::driver::DeviceDisconnectedCallback disconnected,
                       oni::driver::DeviceStateChangedCallback changed, void* cookie) override {
    DriverBase::initialize(connected, disconnected, changed, cookie);
    if (freenect_init(&context_, nullptr) < 0) return ONI_STATUS_OK;  // no USB: no devices
    freenect_set_log_level(context_, FREENECT_LOG_FATAL);
    freenect_select_subdevices(context_, static_cast<freenect_device_flags>(
                                             FREENECT_DEVICE_MOTOR | FREENECT_DEVICE_CAMERA));
    for (const std::string& serial : known_ = SerialNumbers(context_)) {
      const OniDeviceInfo info = MakeDeviceInfo(serial);
      deviceConnected(&info);
    }
    events_ = std::make_unique<EventQueue>();
    thread_ = std::thread([this] { Run(); });
    return ONI_STATUS_OK;
  }

  oni::driver::DeviceBase* deviceOpen(const char* uri, const char*) override {
    const std::lock_guard lock(library_);
    const std::vector<std::string> serials = SerialNumbers(context_);
    for (size_t i = 0; i < serials.size(); ++i) {
      if (MakeDeviceInfo(serials[i]).uri != std::string(uri)) continue;
      auto camera = std::make_unique<FreenectCamera>(context_, library_, static_cast<int>(i),
                                                     ModeFromEnvironment());
      if (!camera->is_open()) break;
      ++open_;
      return new KinectDevice(std::move(camera), serials[i]);
    }
    getServices().errorLoggerAppend(
        "%s: the Kinect cannot be opened (is it in use, or are the "
        "udev rules missing?)",
        uri);
    return nullptr;
  }
  void deviceClose(oni::driver::DeviceBase* device) override {
    delete device;
    --open_;
  }
  OniStatus tryDevice(const char*) override { return ONI_STATUS_ERROR; }

  void shutdown() override {
    stopping_ = true;
    if (thread_.joinable()) thread_.join();
    events_.reset();
    if (context_ != nullptr) freenect_shutdown(context_);
    context_ = nullptr;
  }

 private:
  static OniDeviceInfo MakeDeviceInfo(const std::string& serial) {
    OniDeviceInfo info{};
    CopyName("freenect://" + serial, info.uri);
    CopyName("Microsoft", info.vendor);
    CopyName("Kinect v1", info.name);
    info.usbVendorId = 0x045e;
    info.usbProductId = 0x02ae;
    return info;
  }

  // The only thread that runs libfreenect: handles USB traffic while a Kinect is open, and lists
  // devices once a second.
  void Run() {
    using Clock = std::chrono::steady_clock;
    // Frequently while no device is known, to reconnect within a second. Listing queries all
    // Kinects for their serial numbers, so rarely while they stream.
    constexpr std::chrono::milliseconds kLookEvery{1000};
    constexpr std::chrono::milliseconds kLookWhenNone{250};
    auto last_look = Clock::now();
    while (!stopping_) {
      bool lost = false;
      if (open_ > 0 && !known_.empty()) {
        const std::lock_guard lock(library_);
        timeval patience{0, 20000};
        lost = freenect_process_events_timeout(context_, &patience) < 0;
      } else {
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
      }
      // Releasing the lock only briefly would starve threads that wait to open, start or tilt.
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
      if (lost) LoseDevices();
      if (Clock::now() - last_look < (known_.empty() ? kLookWhenNone : kLookEvery)) continue;
      FindDevices();
      last_look = Clock::now();
    }
  }

  // libfreenect reports that a Kinect was lost, but not which: all are dropped, and present ones
  // are found again by the next listing. The end of fakenect's dump is reported in the same way.
  void LoseDevices() {
    for (const std::string& serial : std::exchange(known_, {})) AnnounceLost(serial);
  }

  void AnnounceLost(const std::string& serial) {
    events_->Now([this, info = MakeDeviceInfo(serial)] { deviceDisconnected(&info); });
  }

  void FindDevices() {
    std::vector<std::string> now;
    {
      const std::lock_guard lock(library_);
      now = SerialNumbers(context_);
    }
    const auto has = [](const std::vector<std::string>& list, const std::string& serial) {
      return std::find(list.begin(), list.end(), serial) != list.end();
    };
    const std::vector<std::string> before = std::exchange(known_, now);
    for (const std::string& serial : before) {
      if (!has(now, serial)) AnnounceLost(serial);
    }
    for (const std::string& serial : now) {
      if (has(before, serial)) continue;
      events_->Now([this, info = MakeDeviceInfo(serial)] { deviceConnected(&info); });
    }
  }

  freenect_context* context_ = nullptr;
  std::recursive_mutex library_;
  std::vector<std::string> known_;
  std::atomic<int> open_ = 0;
  std::atomic<bool> stopping_ = false;
  std::unique_ptr<EventQueue> events_;
  std::thread thread_;
};

}  // namespace
}  // namespace ossa::depth

ONI_EXPORT_DRIVER(ossa::depth::FreenectDriver)
