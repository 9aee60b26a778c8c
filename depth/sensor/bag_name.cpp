#include <system_error>
#include <utility>

#include "depth/base/error.h"
#include "depth/base/lower_case.h"
#include "depth/sensor/bag_name_internal.h"
#include "depth/sensor/folder_listing_internal.h"

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
  return has_files && FilesOf(path, IsPngName).empty();
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

BagName::BagName(const std::string& source) : file(source) {
  const size_t mark = source.rfind('#');
  if (mark == std::string::npos) return;
  fs::path bag = source.substr(0, mark);
  if (!IsRos1Name(bag) && !IsRos2Bag(bag)) return;
  file = std::move(bag);
  topic = source.substr(mark + 1);
}

}  // namespace ossa::depth
