#include <algorithm>
#include <array>
#include <string_view>
#include <system_error>
#include <utility>

#include "depth/base/error.h"
#include "depth/base/lower_case.h"
#include "depth/image/depth_file.h"
#include "depth/sensor/folder_listing_internal.h"
#include "depth/sensor/recording_name_internal.h"

namespace ossa::depth {
namespace {

namespace fs = std::filesystem;

bool IsRos2Name(const fs::path& path) {
  const std::string extension = LowerCaseExtension(path);
  return extension == ".db3" || extension == ".mcap";
}

bool IsPackedRos2Name(const fs::path& path) {
  return LowerCaseExtension(path) == ".zstd" && IsRos2Name(path.stem());
}

// The files of a folder that a name's test selects, without macOS's resource files.
std::vector<fs::path> FilesOf(const fs::path& folder, bool (*is_wanted)(const fs::path&)) {
  std::vector<fs::path> files = FilesIn(folder);
  std::erase_if(files, [is_wanted](const fs::path& path) {
    return !is_wanted(path) || path.filename().string().starts_with('.');
  });
  return files;
}

}  // namespace

bool IsRos1Name(const fs::path& path) {
  const std::string extension = LowerCaseExtension(path);
  return LowerCaseExtension(extension == ".active" ? path.stem() : path) == ".bag";
}

bool IsRos2Bag(const fs::path& path) {
  std::error_code none;
  if (!fs::is_directory(path, none)) return IsRos2Name(path);
  const bool has_files =
      !FilesOf(path, IsRos2Name).empty() || !FilesOf(path, IsPackedRos2Name).empty();
  return has_files && FilesOf(path, IsDepthFileName).empty();
}

std::vector<fs::path> ListRos2Files(const fs::path& bag) {
  std::error_code none;
  if (!fs::is_directory(bag, none)) return {bag};
  const auto files = FilesOf(bag, IsRos2Name), packed = FilesOf(bag, IsPackedRos2Name);
  if (!packed.empty()) {
    throw InputError(packed.front().string() +
                     ": expected a .db3 or .mcap, found one that is compressed: 'zstd -d FILE' "
                     "unpacks it");
  }
  if (files.size() > 1 && !fs::exists(bag / "metadata.yaml", none)) {
    throw InputError(bag.string() +
                     ": expected the metadata.yaml of a ROS 2 bag or one file, found " +
                     std::to_string(files.size()) + " files: name one of them, such as " +
                     files.front().filename().string());
  }
  return files;
}

bool IsArrayName(const fs::path& path) {
  constexpr std::array<std::string_view, 5> kExtensions = {".npy", ".npz", ".mat", ".h5", ".hdf5"};
  return std::find(kExtensions.begin(), kExtensions.end(), LowerCaseExtension(path)) !=
         kExtensions.end();
}

RecordingName::RecordingName(const std::string& source) : file(source) {
  const size_t mark = source.rfind('#');
  if (mark == std::string::npos) return;
  fs::path whole = source.substr(0, mark);
  if (!IsRos1Name(whole) && !IsRos2Bag(whole) && !IsArrayName(whole)) return;
  file = std::move(whole);
  part = source.substr(mark + 1);
}

}  // namespace ossa::depth
