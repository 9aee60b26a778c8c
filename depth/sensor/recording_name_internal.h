#pragma once
#include <filesystem>
#include <string>
#include <vector>

namespace ossa::depth {

/// Whether the name is that of a ROS 1 bag: NAME.bag, or the leftover of a killed recorder:
/// NAME.bag.active.
bool IsRos1Name(const std::filesystem::path& path);

/// Whether the path is a ROS 2 bag: NAME.db3 or NAME.mcap, whether there is such a file or not, or
/// a folder that holds such files and no images.
bool IsRos2Bag(const std::filesystem::path& path);

/// The files of a ROS 2 bag in their order. Throws InputError for a folder of several recordings
/// (without metadata.yaml, as they are copied out of their folders), or of compressed files.
std::vector<std::filesystem::path> ListRos2Files(const std::filesystem::path& bag);

/// Whether the name is that of a file of arrays: NAME.npy, .npz, .mat, .h5 or .hdf5.
bool IsArrayName(const std::filesystem::path& path);

/// BAG or BAG#/topic, of ROS 1 or ROS 2; ARRAYS or ARRAYS#name.
struct RecordingName {
  explicit RecordingName(const std::string& source);
  std::filesystem::path file;  // the source itself if it is neither
  std::string part;            // topic or array; "": none is named
};

}  // namespace ossa::depth
