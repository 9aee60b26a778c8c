#include <system_error>

#include "depth/error.h"
#include "depth/sensor/source_internal.h"

namespace ossa::depth {

std::unique_ptr<FrameSource> OpenSource(const std::string& source, const SourceOptions& options) {
  const std::filesystem::path path(source);
  std::error_code error;
  if (std::filesystem::is_directory(path, error)) {
    return IsDataSet(path) ? OpenDataSet(path, options) : OpenFolder(path, options);
  }
  throw InputError(source +
                   ": expected openni:, openni:URI, FILE.oni, a folder of 16-bit PNGs or a data "
                   "set, found no such thing");
}

}  // namespace ossa::depth
