#pragma once
#include <memory>
#include <string>

#include "depth/sensor/readers/ros/bag_file.h"

namespace ossa::depth {

/// An MCAP file (mcap.dev/spec) of ROS 1 or ROS 2 messages, as rosbag2, Foxglove and Orbbec's
/// recorder write it: chunks, plain or compressed by LZ4 or Zstandard, and messages outside of
/// chunks. One that was not closed is read as far as it is whole. Throws InputError.
std::unique_ptr<BagFile> OpenMcapBag(const std::string& path);

}  // namespace ossa::depth
