#include "depth/sensor/readers/ros/maker_messages.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <string>

namespace ossa::depth {
namespace {

// 0 for what is no number.
double NumberOf(std::string_view text) {
  double value = 0.0;
  std::from_chars(text.data(), text.data() + text.size(), value);
  return value;
}

uint32_t CountOf(std::string_view text) {
  uint32_t value = 0;
  std::from_chars(text.data(), text.data() + text.size(), value);
  return value;
}

// The part before the separator, which is removed from the text with it.
std::string_view TakeUntil(char separator, std::string_view& text) {
  const size_t end = std::min(text.find(separator), text.size());
  const std::string_view part = text.substr(0, end);
  text.remove_prefix(std::min(end + 1, text.size()));
  return part;
}

std::map<std::string_view, std::string_view> FieldsOf(std::string_view text) {
  std::map<std::string_view, std::string_view> fields;
  while (!text.empty()) {
    std::string_view field = TakeUntil(';', text);
    const std::string_view key = TakeUntil('=', field);
    fields[key] = field;
  }
  return fields;
}

// OpenCV's camera matrix.
std::array<double, 9> MatrixOf(double fx, double fy, double cx, double cy) {
  return {fx, 0, cx, 0, fy, cy, 0, 0, 1};
}

}  // namespace

RosCameraInfo ParseRealSenseIntrinsics(std::string_view text) {
  auto fields = FieldsOf(text);
  RosCameraInfo info;
  info.width = CountOf(fields["width"]);
  info.height = CountOf(fields["height"]);
  info.k = MatrixOf(NumberOf(fields["fx"]), NumberOf(fields["fy"]), NumberOf(fields["ppx"]),
                    NumberOf(fields["ppy"]));
  // rs2_distortion: the other models map the other way, or are of fisheyes.
  info.distortion_model = fields["model"] == "Brown Conrady" ? "plumb_bob" : fields["model"];
  for (std::string_view rest = fields["coeffs"]; !rest.empty();) {
    info.d.push_back(NumberOf(TakeUntil(',', rest)));
  }
  return info;
}

RosCameraInfo ParseOrbbecProfile(std::span<const uint8_t> message, RosWire wire) {
  constexpr uint8_t kBrownConrady = 3, kBrownConradyK6 = 4;  // the format's OBCameraDistortionModel
  RosFields fields(message, wire);
  fields.Header();
  fields.Values<uint8_t, 2>();  // stream and format
  fields.Values<float, 12>();   // rotation and translation to the colour camera
  RosCameraInfo info;
  info.width = fields.Value<uint16_t>();
  info.height = fields.Value<uint16_t>();
  fields.Value<uint16_t>();  // frames per second
  const auto k = fields.Values<float, 4>();
  const auto d = fields.Values<float, 8>();  // k1 to k6, p1, p2
  const auto model = fields.Value<uint8_t>();
  info.k = MatrixOf(k[0], k[1], k[2], k[3]);
  info.d = {d[0], d[1], d[6], d[7], d[2], d[3], d[4], d[5]};  // OpenCV's order
  const bool is_known = model == kBrownConrady || model == kBrownConradyK6;
  info.distortion_model =
      is_known ? "rational_polynomial" : "Orbbec's number " + std::to_string(model);
  return info;
}

RosCameraInfo ReadCameraInfo(const BagTopic& topic, std::span<const uint8_t> message) {
  if (topic.type == "custom_msg/OBStreamProfileInfo") {
    return ParseOrbbecProfile(message, topic.wire);
  }
  if (topic.type == "std_msgs/String") {
    return ParseRealSenseIntrinsics(ParseRosText(message, topic.wire));
  }
  return ParseRosCameraInfo(message, topic.wire);
}

double ReadDepthUnit(const BagTopic& topic, std::span<const uint8_t> message) {
  const double metres = topic.type == "std_msgs/String"
                            ? NumberOf(ParseRosText(message, topic.wire))
                            : double{ParseRosFloat(message, topic.wire)};
  return metres > 0 && std::isfinite(metres) ? metres : 0.0;
}

}  // namespace ossa::depth
