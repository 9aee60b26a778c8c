#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "depth/sensor/readers/ros/bag_topics.h"
#include "depth/sensor/readers/ros/ros_messages.h"

namespace ossa::depth {

/// An image of a topic. `image.data` lies in the message or in `unpacked`: to be moved, not copied.
struct BagImage {
  RosImage image;
  std::vector<uint8_t> unpacked;
};

/// Reads sensor_msgs/Image, or sensor_msgs/CompressedImage of depths as image_transport writes
/// them: compressedDepth (PNG, of metres its quantised inverses; or RVL, Wilson 2017) and
/// compressed (PNG of 16 bits). Images in other formats, such as JPEG, have an encoding that is no
/// depth. Throws InputError for a damaged message.
BagImage ReadBagImage(const BagTopic& topic, std::span<const uint8_t> message);

}  // namespace ossa::depth
