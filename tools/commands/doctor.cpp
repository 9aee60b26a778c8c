#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <string>
#include <vector>

#include "depth/base/error.h"
#include "tools/commands/command.h"
#include "tools/commands/commands.h"
#include "tools/commands/doctor_checks.h"

namespace ossa::commands {
namespace {

// The number of findings that need an action.
int Show(const char* title, const std::vector<Finding>& findings, bool quiet) {
  int open = 0;
  if (!quiet) fmt::print("{}\n", title);
  for (const Finding& finding : findings) {
    const bool is_well = finding.to_do.empty();
    if (!quiet || !is_well) fmt::print("  {} {}\n", is_well ? "ok" : "!!", finding.text);
    if (is_well) continue;
    fmt::print("     {}\n", finding.to_do);
    ++open;
  }
  return open;
}

}  // namespace

int Doctor(int argc, char** argv) {
  CLI::App app(
      "Check devices, permissions, drivers and models for problems, and suggest remedies. Exit "
      "status 1 if there is a problem");
  std::string root = "/";
  bool quiet = false;
  app.add_option("--root", root, "look for cameras in sys/ and dev/ of this folder")
      ->capture_default_str();
  app.add_flag("--quiet", quiet, "show problems only");
  Parse(app, argc, argv);
  if (!std::filesystem::is_directory(root)) throw InputError(root + ": expected a folder");
  const int open = Show("cameras", CheckCameras(root), quiet) +
                   Show("drivers of OpenNI2", CheckDrivers(), quiet) +
                   Show("models", CheckModels(), quiet);
  return open == 0 ? 0 : 1;
}

}  // namespace ossa::commands
