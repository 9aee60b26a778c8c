#include "tools/tracker/shipped.h"

#include <dlfcn.h>

#include <algorithm>
#include <cstdlib>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "depth/base/error.h"

namespace ossa::tracker {
namespace {

// The library or program that contains this code: an installed one is beside its share folder,
// wherever the application is.
std::filesystem::path OwnBinary() {
  Dl_info info{};
  return dladdr(reinterpret_cast<const void*>(&ShippedFile), &info) != 0 && info.dli_fname
             ? std::filesystem::path(info.dli_fname)
             : std::filesystem::path();
}

// Folders of shipped files, in order of preference.
std::vector<std::filesystem::path> Folders() {
  std::vector<std::filesystem::path> folders;
  if (const char* share = std::getenv("OSSA_SHARE"); share != nullptr && *share != '\0') {
    folders.emplace_back(share);
  }
  std::error_code error;
  for (const auto& binary : {OwnBinary(), std::filesystem::path("/proc/self/exe")}) {
    const auto real = std::filesystem::canonical(binary, error);
    if (error) continue;
    // The last is for the Python package, which has everything in one folder.
    for (const char* data : {OSSA_DATA_FROM_LIB, OSSA_DATA_FROM_BIN, "share"}) {
      auto folder = (real.parent_path() / data / "ossa").lexically_normal();
      if (folders.empty() || folders.back() != folder) folders.push_back(std::move(folder));
    }
  }
  folders.emplace_back(OSSA_SHIPPED_DIR);
  return folders;
}

}  // namespace

std::filesystem::path ShippedFile(std::string_view name) {
  std::error_code error;
  std::string places;
  for (const auto& folder : Folders()) {
    const auto file = folder / name;
    if (std::filesystem::is_regular_file(file, error)) return file;
    places += (places.empty() ? "" : ", ") + folder.string();
  }
  throw InputError(std::string(name) + ": not among the files shipped with ossa (looked in " +
                   places + "); name one with --model or --database");
}

bool IsShippedFile(const std::filesystem::path& path, std::string_view name) {
  std::error_code error;
  const auto folders = Folders();
  const auto first = std::find_if(folders.begin(), folders.end(), [&](const auto& folder) {
    return std::filesystem::is_regular_file(folder / name, error);
  });
  return first != folders.end() && std::filesystem::equivalent(path, *first / name, error);
}

}  // namespace ossa::tracker
