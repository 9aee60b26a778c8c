#include <algorithm>
#include <cctype>
#include <system_error>

#include "depth/base/error.h"
#include "depth/sensor/folder_listing_internal.h"
#include "depth/sensor/source_internal.h"

namespace ossa::depth {
namespace {

constexpr std::string_view kDevicePrefix = "openni:";

std::string LowerCaseExtension(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension;
}

// NAME.oni, and what a recorder of it that was killed left: NAME.oni.partial-...
bool IsOniName(const std::filesystem::path& path) {
  constexpr const char* kPartial = ".partial-";
  const bool is_left = path.extension().string().starts_with(kPartial);
  return LowerCaseExtension(is_left ? path.stem() : path) == ".oni";
}

}  // namespace

bool IsRecording(const std::filesystem::path& path) {
  if (!std::filesystem::is_directory(path)) {
    return IsOniName(path) || IsPngName(path);
  }
  const std::filesystem::directory_iterator entries(path);
  return std::any_of(begin(entries), end(entries), [](const auto& entry) {
    return IsPngName(entry.path()) || entry.path().filename() == "depth.txt";
  });
}

std::unique_ptr<FrameSource> OpenSource(const std::string& source, const SourceOptions& options) {
  if (source.starts_with(kDevicePrefix)) {
    // OpenNI2 takes a file for a device, and plays it again and again with the times of its end.
    const std::string uri = source.substr(kDevicePrefix.size());
    std::error_code none;
    if (std::filesystem::is_regular_file(uri, none)) return OpenSource(uri, options);
    return Prepared(source, OpenOpenNiDevice(uri, options), UnitStated::kYes, options);
  }
  const std::filesystem::path path(source);
  std::error_code error;
  if (std::filesystem::is_directory(path, error)) {
    return Prepared(source,
                    IsDataSet(path) ? OpenDataSet(path, options) : OpenFolder(path, options),
                    UnitStated::kNo, options);
  }
  if (IsOniName(path)) {
    return Prepared(source, OpenOniFile(path, options), UnitStated::kYes, options);
  }
  if (IsPngName(path) && std::filesystem::exists(path, error)) {
    return Prepared(source, OpenStill(path, options), UnitStated::kNo, options);
  }
  throw InputError(source +
                   ": expected openni:, openni:URI, FILE.oni, a 16-bit PNG or a folder of them, or "
                   "a data set, found no such thing");
}

}  // namespace ossa::depth
