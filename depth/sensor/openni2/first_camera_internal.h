#pragma once
#include <set>
#include <string>
#include <vector>

namespace ossa::depth {

/// A device listed by OpenNI2.
struct ListedDevice {
  std::string uri;
  std::string make;  // vendor, name and USB ids
};

/// All connected devices.
std::vector<ListedDevice> ListDevices();

/// Selects the camera for "openni:": the first one, and from then on always that one. A reconnected
/// USB camera may have another URI: it is then one of the same make that was absent when it was
/// lost.
class FirstCamera {
 public:
  /// Its URI; "" while it is not connected.
  std::string Find() const;
  /// Records that it was opened.
  void Opened(const std::string& uri);
  /// Records that it was unplugged: all devices present now are others.
  void Gone();
  const std::string& uri() const { return own_.uri; }

 private:
  ListedDevice own_;
  std::set<std::string> others_;
};

}  // namespace ossa::depth
