#include <algorithm>
#include <cctype>
#include <system_error>

#include "depth/error.h"
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

}  // namespace

bool IsRecordingFile(const std::filesystem::path& path) {
  const std::string extension = LowerCaseExtension(path);
  return extension == ".oni" || extension == ".png";
}

std::unique_ptr<FrameSource> OpenSource(const std::string& source, const SourceOptions& options) {
  if (source.starts_with(kDevicePrefix)) {
    return OpenOpenNiDevice(source.substr(kDevicePrefix.size()), options);
  }
  const std::filesystem::path path(source);
  std::error_code error;
  if (std::filesystem::is_directory(path, error)) {
    return IsDataSet(path) ? OpenDataSet(path, options) : OpenFolder(path, options);
  }
  const std::string extension = LowerCaseExtension(path);
  if (extension == ".oni") return OpenOniFile(path, options);
  if (extension == ".png" && std::filesystem::exists(path, error)) {
    return OpenStill(path, options);
  }
  throw InputError(source +
                   ": expected openni:, openni:URI, FILE.oni, a 16-bit PNG or a folder of them, or "
                   "a data set, found no such thing");
}

}  // namespace ossa::depth
