#pragma once
#include <memory>
#include <string>

#include "depth/sensor/readers/ros/bag_file.h"

namespace ossa::depth {

/// A .db3 of rosbag2 or of RealSense's recorder: an SQLite database of topics and messages, each of
/// which may be compressed by Zstandard. Throws InputError.
std::unique_ptr<BagFile> OpenSqliteBag(const std::string& path);

}  // namespace ossa::depth
