#include "depth/sensor/readers/bag_topics.h"

#include <algorithm>
#include <string_view>

#include "depth/base/error.h"
#include "depth/base/lower_case.h"

namespace ossa::depth {
namespace {

bool SaysDepth(std::string_view name) { return LowerCase(name).find("depth") != std::string::npos; }

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
bool IsItsOwn(const std::string& topic, const std::string& image) {
  return NamespaceOf(topic) == NamespaceOf(image) ||
         SaysDepth(image.substr(0, CommonBeginning(image, topic).characters));
}

// The topic of this type and suffix in the image's namespace, else in the one that shares the
// longest part with it: more than the leading /, so that it does not belong to another camera.
std::string SiblingTopic(const std::string& image, const std::vector<BagTopic>& topics,
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

}  // namespace

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
      throw InputError("expected a topic of sensor_msgs/Image in 16UC1, mono16 or 32FC1, found " +
                       Listed(names) + " (compressedDepth: republish it as raw first)");
    }
    choice.image = *std::min_element(depth.begin(), depth.end(), [](const auto& a, const auto& b) {
      if (SaysDepth(a) != SaysDepth(b)) return SaysDepth(a);
      return a.size() != b.size() ? a.size() < b.size() : a < b;
    });
    if (depth.size() > 1) {
      choice.notes.push_back("reads " + choice.image + " of its depth topics " + Listed(depth) +
                             ": FILE.bag#TOPIC selects another");
    }
  }
  choice.camera_info = SiblingTopic(choice.image, topics, "sensor_msgs/CameraInfo", "camera_info");
  choice.is_info_own = !choice.camera_info.empty() && IsItsOwn(choice.camera_info, choice.image);
  if (!choice.camera_info.empty() && !choice.is_info_own) {
    choice.notes.push_back("has no camera_info of " + choice.image + "'s own and takes " +
                           choice.camera_info + ": --camera sets another");
  }
  for (const char* unit : {"Depth_Units/value", "Depth Units/value"}) {  // by librealsense version
    if (!choice.unit.empty()) break;
    choice.unit = SiblingTopic(choice.image, topics, "std_msgs/Float32", unit);
  }
  return choice;
}

}  // namespace ossa::depth
