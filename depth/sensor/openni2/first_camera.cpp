#include <OpenNI.h>

#include <algorithm>

#include "depth/sensor/openni2/first_camera_internal.h"

namespace ossa::depth {

std::vector<ListedDevice> ListDevices() {
  openni::Array<openni::DeviceInfo> infos;
  openni::OpenNI::enumerateDevices(&infos);
  std::vector<ListedDevice> devices;
  for (int i = 0; i < infos.getSize(); ++i) {
    const openni::DeviceInfo& info = infos[i];
    devices.push_back({info.getUri(), std::string(info.getVendor()) + "/" + info.getName() + "/" +
                                          std::to_string(info.getUsbVendorId()) + "/" +
                                          std::to_string(info.getUsbProductId())});
  }
  return devices;
}

std::string FirstCamera::Find() const {
  const std::vector<ListedDevice> devices = ListDevices();
  if (own_.uri.empty()) return devices.empty() ? "" : devices.front().uri;
  const auto find = [&](const auto& is_it) {
    const auto found = std::find_if(devices.begin(), devices.end(), is_it);
    return found == devices.end() ? "" : found->uri;
  };
  const std::string same = find([&](const auto& device) { return device.uri == own_.uri; });
  if (!same.empty()) return same;
  return find([&](const auto& device) {
    return device.make == own_.make && !others_.contains(device.uri);
  });
}

void FirstCamera::Opened(const std::string& uri) {
  own_ = {uri, ""};
  for (const ListedDevice& device : ListDevices()) {
    if (device.uri == uri) own_ = device;
  }
}

void FirstCamera::Gone() {
  others_.clear();
  for (const ListedDevice& device : ListDevices()) others_.insert(device.uri);
}

}  // namespace ossa::depth
