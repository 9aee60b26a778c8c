#pragma once
#include <set>
#include <string>
#include <vector>

namespace ossa::depth {

/// A device that OpenNI2 knows of.
struct ListedDevice {
  std::string uri;
  std::string make;  // whose, what, and its USB numbers
};

/// All that are plugged in.
std::vector<ListedDevice> ListDevices();

/// The camera among those listed that "openni:" stands for: the first, and ever after that one. A
/// USB camera that is plugged in again may have another URI: it is then one of its make that was
/// not there when it went.
class FirstCamera {
 public:
  /// Its URI; "" while it is not there.
  std::string Find() const;
  /// It was opened.
  void Opened(const std::string& uri);
  /// It was unplugged: whatever is there now is another.
  void Gone();
  const std::string& uri() const { return own_.uri; }

 private:
  ListedDevice own_;
  std::set<std::string> others_;
};

}  // namespace ossa::depth
