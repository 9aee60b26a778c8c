#pragma once
#include <filesystem>
#include <string>
#include <vector>

namespace ossa::commands {

/// One thing that was looked at, and what to do about it; nothing where all is well.
struct Finding {
  std::string text;
  std::string to_do;
};

/// Depth cameras on this machine's USB, whether this user may open them, and whether another driver
/// of the kernel's holds them. `root` is where sys/ and dev/ lie: "/", or a folder with those of
/// another machine.
std::vector<Finding> CheckCameras(const std::filesystem::path& root);

/// OpenNI2 and the drivers that it loads, each tried.
std::vector<Finding> CheckDrivers();

/// The shipped models, each read.
std::vector<Finding> CheckModels();

}  // namespace ossa::commands
