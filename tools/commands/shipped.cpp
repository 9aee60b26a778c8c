#include "tools/commands/shipped.h"

#include <filesystem>

#include "depth/error.h"
#include "recon/database/posture_database.h"

namespace ossa::commands {
namespace {

/// The shipped database beside the program: installed (../share/ossa), or in the source tree above
/// a build folder.
std::filesystem::path ShippedDatabase() {
  namespace fs = std::filesystem;
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  fs::path folder = program.parent_path();
  for (int up = 0; up < 5 && !folder.empty(); ++up, folder = folder.parent_path()) {
    for (const char* place : {"share/ossa", "tools/tracker/shipped"}) {
      const fs::path file = folder / place / "authored.ossadb";
      if (fs::exists(file, error)) return file;
    }
  }
  throw InputError(
      "authored.ossadb: the shipped posture database is not beside the program; "
      "name one with --database");
}

}  // namespace

std::shared_ptr<const recon::PostureDatabase> LoadDatabase(const std::string& file) {
  const std::filesystem::path path = file.empty() ? ShippedDatabase() : std::filesystem::path(file);
  return std::make_shared<recon::PostureDatabase>(recon::PostureDatabase::Load(path));
}

}  // namespace ossa::commands
