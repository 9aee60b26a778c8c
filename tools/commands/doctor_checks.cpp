#include "tools/commands/doctor_checks.h"

#include <dlfcn.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <string_view>
#include <system_error>

#include "depth/base/error.h"
#include "depth/base/one_line.h"
#include "depth/sensor/openni2/runtime_folder.h"
#include "recon/models/learned_models.h"
#include "recon/skeleton_sequence.h"
#include "tools/tracker/body_mesh_file.h"
#include "tools/tracker/model_set.h"
#include "tools/tracker/shipped.h"

namespace ossa::commands {
namespace {

namespace fs = std::filesystem;

enum class Way { kFreenect, kPrimeSense, kMakersOwn, kNoCamera };

// USB vendor and product ids from the makers' drivers and udev rules: libfreenect's, OpenNI2's,
// libfreenect2's, the Azure Kinect SDK's, librealsense's and OrbbecSDK's.
struct KnownDevice {
  std::string_view id;
  std::string_view name;
  Way way;
};
constexpr KnownDevice kDevices[] = {
    {"045e:02ae", "Kinect for Xbox 360", Way::kFreenect},
    {"045e:02bf", "Kinect for Windows v1", Way::kFreenect},
    {"045e:02b0", "motor of a Kinect for Xbox 360", Way::kNoCamera},
    {"045e:02c2", "hub of a Kinect for Windows v1", Way::kNoCamera},
    {"1d27:0401", "PrimeSense sensor", Way::kPrimeSense},
    {"1d27:0500", "PrimeSense sensor", Way::kPrimeSense},
    {"1d27:0600", "Asus Xtion PRO or PrimeSense Carmine", Way::kPrimeSense},
    {"1d27:0601", "Asus Xtion PRO LIVE or PrimeSense Carmine", Way::kPrimeSense},
    {"1d27:0609", "PrimeSense Carmine 1.09", Way::kPrimeSense},
    {"045e:02c4", "Kinect v2", Way::kMakersOwn},
    {"045e:02d8", "Kinect v2", Way::kMakersOwn},
    {"045e:097c", "Azure Kinect", Way::kMakersOwn},
    {"8086:0aa5", "RealSense SR300", Way::kMakersOwn},
    {"8086:0ad3", "RealSense D415", Way::kMakersOwn},
    {"8086:0ad4", "RealSense D430", Way::kMakersOwn},
    {"8086:0b07", "RealSense D435", Way::kMakersOwn},
    {"8086:0b3a", "RealSense D435i", Way::kMakersOwn},
    {"8086:0b48", "RealSense SR305", Way::kMakersOwn},
    {"8086:0b5b", "RealSense D405", Way::kMakersOwn},
    {"8086:0b5c", "RealSense D455", Way::kMakersOwn},
    {"8086:0b64", "RealSense L515", Way::kMakersOwn},
    {"2bc5:0669", "Orbbec Femto Mega", Way::kMakersOwn},
    {"2bc5:066b", "Orbbec Femto Bolt", Way::kMakersOwn},
};

struct UsbDevice {
  fs::path folder;  // in sysfs
  KnownDevice known;
  fs::path node;  // the device file that programs open
};

std::string FirstWord(const fs::path& file) {
  std::ifstream in(file);
  std::string word;
  in >> word;
  return word;
}

std::vector<UsbDevice> FindKnownDevices(const fs::path& root) {
  std::vector<UsbDevice> devices;
  std::error_code unreadable;
  for (const auto& entry : fs::directory_iterator(root / "sys/bus/usb/devices", unreadable)) {
    const fs::path folder = entry.path();
    const std::string id = FirstWord(folder / "idVendor") + ":" + FirstWord(folder / "idProduct");
    const auto is_it = [&](const KnownDevice& known) { return known.id == id; };
    const auto* known = std::find_if(std::begin(kDevices), std::end(kDevices), is_it);
    if (known == std::end(kDevices)) continue;
    const auto number = [&](const char* file) {
      return fmt::format("{:0>3}", OnOneLine(FirstWord(folder / file)));
    };
    devices.push_back({folder, *known, root / "dev/bus/usb" / number("busnum") / number("devnum")});
  }
  const auto by_folder = [](const UsbDevice& a, const UsbDevice& b) { return a.folder < b.folder; };
  std::sort(devices.begin(), devices.end(), by_folder);
  return devices;
}

// The kernel driver of an interface of the device, "1-2:1.0" of "1-2"; empty if there is none.
std::string FindVideoDriver(const UsbDevice& device) {
  std::error_code unreadable;
  const std::string prefix = device.folder.filename().string() + ":";
  for (const auto& entry : fs::directory_iterator(device.folder.parent_path(), unreadable)) {
    if (!entry.path().filename().string().starts_with(prefix)) continue;
    const fs::path driver = fs::read_symlink(entry.path() / "driver", unreadable).filename();
    if (driver.string().starts_with("gspca_")) return driver.string();
  }
  return {};
}

std::string DescribeRemedy(const UsbDevice& device) {
  if (device.known.way == Way::kMakersOwn) {
    return "no OpenNI2 driver of Debian's: record with its maker's software, or let its Python "
           "wheel send its images, as 'realsense.py --pipe | ossa view -' (docs/cameras.md)";
  }
  const std::string driver = FindVideoDriver(device);
  if (!driver.empty()) {
    return fmt::format(
        "the kernel's {0} holds it: sudo modprobe -r {0}; echo blacklist {0} | sudo "
        "tee /etc/modprobe.d/ossa.conf",
        driver);
  }
  std::error_code unknown;
  if (!fs::exists(device.node, unknown)) {
    return device.node.string() + " is absent: give this container the machine's /dev/bus/usb";
  }
  if (access(device.node.c_str(), R_OK | W_OK) == 0) return {};
  const char* group = device.known.way == Way::kPrimeSense ? "video" : "plugdev";
  return fmt::format(
      "this user may not open {}: sudo usermod -aG {} $USER, log in again, and plug "
      "it in again",
      device.node.string(), group);
}

// Motor and hub are powered by USB; the camera has a power supply of its own.
bool IsWithoutPower(const std::vector<UsbDevice>& devices) {
  const auto has = [&](Way way) {
    return std::any_of(devices.begin(), devices.end(),
                       [&](const UsbDevice& device) { return device.known.way == way; });
  };
  return has(Way::kNoCamera) && !has(Way::kFreenect);
}

Finding CheckDriver(const fs::path& file) {
  const std::string name = file.filename().string();
  if (void* library = dlopen(file.c_str(), RTLD_LAZY | RTLD_LOCAL); library != nullptr) {
    return {name, {}};
  }
  const char* why = dlerror();
  return {fmt::format("{}: {}", name, why == nullptr ? "cannot be loaded" : OnOneLine(why)),
          "install what it needs: apt install libopenni2-0 libfreenect0.5"};
}

// The ceiling models are loaded in the middle of a run, which would end there.
void ReadUsualModels() {
  const auto models = tracker::ModelSet::Shipped();
  tracker::LoadCeilingModels(models, tracker::LoadCeilingForest(models));
}
void ReadPostures() { tracker::LoadDatabase({}, "plantard-2016"); }
void ReadSensorCorrection() {
  recon::LearnedModels::Load(
      tracker::ShippedFile(tracker::FindKnownSensor(recon::kKinectV2)->correction));
}
void ReadSkin() { tracker::LoadBodyMesh(); }

}  // namespace

std::vector<Finding> CheckCameras(const fs::path& root) {
  const std::vector<UsbDevice> devices = FindKnownDevices(root);
  std::vector<Finding> findings;
  for (const UsbDevice& device : devices) {
    if (device.known.way == Way::kNoCamera) continue;
    findings.push_back(
        {fmt::format("{} ({})", device.known.name, device.known.id), DescribeRemedy(device)});
  }
  if (IsWithoutPower(devices)) {
    findings.push_back({"a Kinect v1 of which the camera is not seen",
                        "plug in its power supply: the camera has no power from the USB"});
  }
  if (findings.empty()) {
    findings.push_back(
        {"none that ossa knows is plugged in; `openni:ossa://RECORDING?loop=1` "
         "plays a recording as one",
         {}});
  }
  return findings;
}

std::vector<Finding> CheckDrivers() {
  std::vector<fs::path> files;
  try {
    const fs::path folder = depth::OpenNiRuntimeFolder();
    for (const auto& entry : fs::directory_iterator(folder / "OpenNI2/Drivers")) {
      if (entry.path().filename().string().starts_with("lib")) files.push_back(entry.path());
    }
    files.push_back(folder / "libOpenNI2.so.0");
  } catch (const std::exception& error) {
    return {{OnOneLine(error.what()), "reinstall ossa"}};
  }
  std::sort(files.begin(), files.end());
  std::vector<Finding> findings;
  for (const fs::path& file : files) findings.push_back(CheckDriver(file));
  return findings;
}

std::vector<Finding> CheckModels() {
  std::vector<Finding> findings;
  for (const auto read : {ReadUsualModels, ReadPostures, ReadSensorCorrection, ReadSkin}) {
    try {
      read();
    } catch (const InputError& error) {
      findings.push_back(
          {OnOneLine(error.what()), "reinstall ossa, or name the folder in OSSA_SHARE"});
    }
  }
  if (!findings.empty()) return findings;
  return {{"in " + tracker::ShippedFile("body.ossa").parent_path().string(), {}}};
}

}  // namespace ossa::commands
