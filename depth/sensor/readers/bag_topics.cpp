#include "depth/sensor/readers/bag_topics.h"

#include <algorithm>
#include <cctype>
#include <string_view>

#include "depth/base/error.h"

namespace ossa::depth {
namespace {

bool SaysDepth(std::string name) {
  std::transform(name.begin(), name.end(), name.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return name.find("depth") != std::string::npos;
}

std::string Listed(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text.empty() ? "none" : text;
}

size_t CommonBeginning(std::string_view a, std::string_view b) {
  return static_cast<size_t>(std::mismatch(a.begin(), a.end(), b.begin(), b.end()).first -
                             a.begin());
}

// The topic of this type and ending whose name has most in common with the image's.
std::string Beside(const std::string& image, const std::vector<BagTopic>& topics,
                   std::string_view type, std::string_view ending) {
  std::string best;
  size_t most = 1;  // the / that all begin with
  for (const BagTopic& topic : topics) {
    const size_t common = CommonBeginning(image, topic.name);
    if (topic.type != type || !topic.name.ends_with(ending) || common <= most) continue;
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
      choice.note = "reads " + choice.image + " of its depth topics " + Listed(depth) +
                    ": FILE.bag#TOPIC says otherwise";
    }
  }
  choice.camera_info = Beside(choice.image, topics, "sensor_msgs/CameraInfo", "camera_info");
  for (const char* unit : {"Depth_Units/value", "Depth Units/value"}) {  // as librealsense aged
    if (choice.unit.empty()) choice.unit = Beside(choice.image, topics, "std_msgs/Float32", unit);
  }
  return choice;
}

}  // namespace ossa::depth
