#pragma once
#include <filesystem>
#include <string>
#include <vector>

namespace ossa::commands {

/// The result of a check, and what to do about it; no action if all is well.
struct Finding {
  std::string text;
  std::string to_do;
};

/// Depth cameras on this machine's USB, whether this user may open them, and whether another kernel
/// driver claims them. `root` contains sys/ and dev/: "/", or a folder with a copy of another
/// machine's.
std::vector<Finding> CheckCameras(const std::filesystem::path& root);

/// OpenNI2 and its drivers, each loaded.
std::vector<Finding> CheckDrivers();

/// The shipped models, each loaded.
std::vector<Finding> CheckModels();

}  // namespace ossa::commands
