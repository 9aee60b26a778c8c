#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "depth/sensor/readers/ros/ros_fields.h"

namespace ossa::depth {

struct BagTopic {
  std::string name;
  std::string type;  // as ROS 1 has it: sensor_msgs/Image
  RosWire wire = RosWire::kRos1;
};

/// The topics of a bag to read.
struct BagChoice {
  std::string image;
  std::string camera_info;         // of any type of maker_messages.h; "": there is none
  bool is_info_own = false;        // belongs to the image's sensor, so its distortion applies
  std::string unit;                // of RealSense's recorder, metres; "": there is none
  std::vector<std::string> notes;  // for the user, about ambiguous choices
};

/// `depth`: topics of 16-bit or metric images. If none is requested, those of depth by their name
/// are preferred, then the shortest name. Throws InputError naming the available topics.
BagChoice ChooseDepthTopic(const std::vector<std::string>& depth,
                           const std::vector<BagTopic>& topics, const std::string& asked);

/// The topic's images before a plugin of image_transport compressed them: without /compressedDepth.
std::string_view WithoutTransport(std::string_view topic);

/// A type as ROS 1 has it: sensor_msgs/Image for sensor_msgs/msg/Image.
std::string Ros1TypeOf(std::string type);

}  // namespace ossa::depth
