#include "tools/tracker/shipped.h"

#include <cstdlib>
#include <string>
#include <system_error>
#include <vector>

#include "depth/error.h"

namespace ossa::tracker {

std::filesystem::path ShippedFile(std::string_view name) {
  std::vector<std::filesystem::path> folders;
  if (const char* share = std::getenv("OSSA_SHARE"); share != nullptr && *share != '\0') {
    folders.emplace_back(share);
  }
  std::error_code error;
  const auto program = std::filesystem::read_symlink("/proc/self/exe", error);
  if (!error) folders.push_back(program.parent_path().parent_path() / "share" / "ossa");
  folders.emplace_back(OSSA_SHIPPED_DIR);
  std::string places;
  for (const auto& folder : folders) {
    const auto file = folder / name;
    if (std::filesystem::is_regular_file(file, error)) return file;
    places += (places.empty() ? "" : ", ") + folder.string();
  }
  throw InputError(std::string(name) + ": not among the files shipped with ossa (looked in " +
                   places + "); name one with --model or --database");
}

}  // namespace ossa::tracker
