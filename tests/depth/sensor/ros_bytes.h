#pragma once
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <vector>

#include "depth/sensor/readers/ros/ros_fields.h"

namespace ossa::test {

/// The fields of a message.
class RosBytes {
 public:
  explicit RosBytes(depth::RosWire wire = depth::RosWire::kRos1) : wire_(wire) {
    if (is_cdr()) bytes = {0, 1, 0, 0};  // little-endian
  }
  template <typename T>
  RosBytes& Add(const T& value) {
    while (is_cdr() && (bytes.size() - kEncapsulation) % sizeof(T) != 0) bytes.push_back(0);
    const auto* at = reinterpret_cast<const uint8_t*>(&value);
    bytes.insert(bytes.end(), at, at + sizeof(T));
    return *this;
  }
  RosBytes& AddText(const std::string& text) {
    Add(static_cast<uint32_t>(text.size() + (is_cdr() ? 1 : 0)));
    bytes.insert(bytes.end(), text.begin(), text.end());
    if (is_cdr()) bytes.push_back(0);
    return *this;
  }
  /// stamp, frame_id, and in ROS 1 seq before them.
  RosBytes& AddHeader(uint32_t seconds, uint32_t nanoseconds) {
    if (!is_cdr()) Add(uint32_t{7});
    return Add(seconds).Add(nanoseconds).AddText("camera");
  }
  RosBytes& AddSequence(std::span<const uint8_t> sequence) {
    Add(static_cast<uint32_t>(sequence.size()));
    bytes.insert(bytes.end(), sequence.begin(), sequence.end());
    return *this;
  }
  std::vector<uint8_t> bytes;

 private:
  static constexpr size_t kEncapsulation = 4;  // bytes
  bool is_cdr() const { return wire_ == depth::RosWire::kCdr; }
  depth::RosWire wire_;
};

template <typename Sample = uint16_t>
std::vector<uint8_t> RosImageBytes(const std::string& encoding, uint32_t width, uint32_t height,
                                   const std::vector<Sample>& samples, uint32_t step,
                                   bool is_bigendian = false, uint32_t seconds = 100,
                                   depth::RosWire wire = depth::RosWire::kRos1) {
  RosBytes message(wire);
  message.AddHeader(seconds, 250'000'000).Add(height).Add(width).AddText(encoding);
  message.Add(static_cast<uint8_t>(is_bigendian)).Add(step);
  message.Add(static_cast<uint32_t>(samples.size() * sizeof(Sample)));
  for (const Sample sample : samples) message.Add(sample);
  return message.bytes;
}

/// Its centre is the image's.
struct RosCameraInfoFields {
  uint32_t width = 0, height = 0;
  double f = 0.0, rectified_f = 0.0;
  uint32_t left = 0, top = 0, region_width = 0, region_height = 0;  // 0: the whole image
  std::string lens_model = "plumb_bob";
  std::vector<double> lens = {0.0};
};
inline std::vector<uint8_t> RosCameraInfoBytes(const RosCameraInfoFields& info,
                                               depth::RosWire wire = depth::RosWire::kRos1) {
  const double cx = info.width / 2.0, cy = info.height / 2.0;
  const double f = info.f, r = info.rectified_f;
  RosBytes message(wire);
  message.AddHeader(100, 0).Add(info.height).Add(info.width).AddText(info.lens_model);
  message.Add(static_cast<uint32_t>(info.lens.size()));
  for (const double d : info.lens) message.Add(d);
  for (const double k : {f, 0.0, cx, 0.0, f, cy, 0.0, 0.0, 1.0}) message.Add(k);
  for (const double one : {1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0}) message.Add(one);
  for (const double p : {r, 0.0, cx, 0.0, 0.0, r, cy, 0.0, 0.0, 0.0, 1.0, 0.0}) message.Add(p);
  message.Add(uint32_t{0}).Add(uint32_t{0});  // binning
  message.Add(info.left).Add(info.top).Add(info.region_height).Add(info.region_width);
  message.Add(uint8_t{0});
  return message.bytes;
}
inline std::vector<uint8_t> RosCameraInfoBytes(uint32_t width, uint32_t height, double f) {
  return RosCameraInfoBytes({.width = width, .height = height, .f = f});
}

}  // namespace ossa::test
