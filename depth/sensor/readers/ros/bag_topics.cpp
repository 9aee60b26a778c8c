#include "depth/sensor/readers/ros/bag_topics.h"

#include <algorithm>
#include <array>
#include <span>
#include <string_view>

#include "depth/base/error.h"
#include "depth/base/lower_case.h"

namespace ossa::depth {
namespace {

// Of Orbbec's recorder, by its numbers of sensors and streams (OBSensorType, OBStreamType).
constexpr std::string_view kOrbbecDepth = "/cam/sensor_3/frameType_3";
constexpr std::string_view kOrbbecProfile = "/cam/streamProfileType_3";

bool SaysDepth(std::string_view name) {
  return LowerCase(name).find("depth") != std::string::npos || name == kOrbbecDepth;
}

std::string Listed(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text.empty() ? "none" : text;
}

// A topic's namespace: its name up to the last /.
std::string_view NamespaceOf(std::string_view topic) {
  return topic.substr(0, topic.rfind('/') + 1);
}

// Length of the common prefix of two names, in characters.
struct Common {
  size_t namespaces = 0;  // in complete namespaces: only "/" for /camera1/ and /camera2/
  size_t characters = 0;
  auto operator<=>(const Common&) const = default;
};

Common CommonBeginning(std::string_view a, std::string_view b) {
  const auto characters =
      static_cast<size_t>(std::mismatch(a.begin(), a.end(), b.begin(), b.end()).first - a.begin());
  return {NamespaceOf(a.substr(0, characters)).size(), characters};
}

// Whether a topic belongs to the image's sensor: it is in the same namespace, or in a depth
// namespace that both share.
bool IsItsOwn(std::string_view topic, std::string_view image) {
  return NamespaceOf(topic) == NamespaceOf(image) || topic == kOrbbecProfile ||
         SaysDepth(image.substr(0, CommonBeginning(image, topic).characters));
}

// The topic of this type and suffix in the image's namespace, else in the one that shares the
// longest part with it: more than the leading /, so that it does not belong to another camera.
std::string SiblingTopic(std::string_view image, const std::vector<BagTopic>& topics,
                         std::string_view type, std::string_view ending) {
  std::string best;
  Common most;
  for (const BagTopic& topic : topics) {
    const Common common = CommonBeginning(image, topic.name);
    const bool is_beside = common.namespaces > 1 || NamespaceOf(topic.name) == NamespaceOf(image);
    if (topic.type != type || !topic.name.ends_with(ending) || !is_beside || common <= most) {
      continue;
    }
    best = topic.name;
    most = common;
  }
  return best;
}

// Of a type, by the ending of its name.
struct Wanted {
  std::string_view type, ending;
};

// The first of these that the image has.
std::string FirstSibling(std::string_view image, const std::vector<BagTopic>& topics,
                         std::span<const Wanted> wanted) {
  for (const Wanted& each : wanted) {
    std::string found = SiblingTopic(image, topics, each.type, each.ending);
    if (!found.empty()) return found;
  }
  return {};
}

std::string FindCameraInfo(std::string_view image, const std::vector<BagTopic>& topics) {
  if (image == kOrbbecDepth) {
    const std::array<Wanted, 1> profile = {
        Wanted{"custom_msg/OBStreamProfileInfo", kOrbbecProfile}};
    return FirstSibling(image, topics, profile);
  }
  constexpr std::array kInfos = {
      Wanted{"sensor_msgs/CameraInfo", "camera_info"},
      Wanted{"std_msgs/String", "camera_info"}};  // early .db3 of RealSense's recorder
  return FirstSibling(image, topics, kInfos);
}

// RealSense's recorder, by its version: of ROS 1 and ROS 2.
std::string FindUnit(std::string_view image, const std::vector<BagTopic>& topics) {
  constexpr std::array kUnits = {Wanted{"std_msgs/Float32", "Depth_Units/value"},
                                 Wanted{"std_msgs/Float32", "Depth Units/value"},
                                 Wanted{"std_msgs/String", "Depth_Units/value"}};
  return FirstSibling(image, topics, kUnits);
}

}  // namespace

std::string_view WithoutTransport(std::string_view topic) {
  for (const std::string_view transport : {"/compressedDepth", "/compressed"}) {
    if (topic.ends_with(transport)) return topic.substr(0, topic.size() - transport.size());
  }
  return topic;
}

BagChoice ChooseDepthTopic(const std::vector<std::string>& depth,
                           const std::vector<BagTopic>& topics, const std::string& asked) {
  BagChoice choice;
  if (!asked.empty()) {
    if (std::find(depth.begin(), depth.end(), asked) == depth.end()) {
      throw InputError("expected one of its depth topics (" + Listed(depth) + "), found '" + asked +
                       "'");
    }
    choice.image = asked;
  } else {
    if (depth.empty()) {
      std::vector<std::string> names;
      for (const BagTopic& topic : topics) names.push_back(topic.name);
      throw InputError(
          "expected a topic of sensor_msgs/Image in 16UC1, mono16 or 32FC1, or of its "
          "compressedDepth, found " +
          Listed(names));
    }
    choice.image = *std::min_element(depth.begin(), depth.end(), [](const auto& a, const auto& b) {
      if (SaysDepth(a) != SaysDepth(b)) return SaysDepth(a);
      return a.size() != b.size() ? a.size() < b.size() : a < b;
    });
    if (depth.size() > 1) {
      choice.notes.push_back("reads " + choice.image + " of its depth topics " + Listed(depth) +
                             ": FILE#TOPIC selects another");
    }
  }
  const std::string_view image = WithoutTransport(choice.image);
  choice.camera_info = FindCameraInfo(image, topics);
  choice.is_info_own = !choice.camera_info.empty() && IsItsOwn(choice.camera_info, image);
  if (!choice.camera_info.empty() && !choice.is_info_own) {
    choice.notes.push_back("has no camera_info of " + choice.image + "'s own and takes " +
                           choice.camera_info + ": --camera sets another");
  }
  choice.unit = FindUnit(image, topics);
  return choice;
}

std::string Ros1TypeOf(std::string type) {
  constexpr std::string_view kRos2 = "/msg/";
  const size_t at = type.find(kRos2);
  if (at != std::string::npos) type.erase(at, kRos2.size() - 1);
  return type;
}

}  // namespace ossa::depth
