#pragma once
#include <chrono>
#include <memory>
#include <string>

#include "depth/sensor/frame_source.h"

namespace CLI {
class App;
}

namespace ossa::commands {

/// A SOURCE and how it is read, the same for every command that has one.
struct SourceArguments {
  std::string name, camera;
  double wait_s = 0.0;
  double patience_s = 5.0;
};

/// SOURCE and --camera.
void AddSourceOptions(CLI::App& app, SourceArguments& arguments);
/// --wait and --patience, for what a device may do.
void AddDeviceOptions(CLI::App& app, SourceArguments& arguments);

/// What the arguments say of --camera; throws UsageError.
depth::SourceOptions CameraOptions(const SourceArguments& arguments);

/// Waits for a device as --wait asks, says so once unless quiet, and gives up at Ctrl-C.
std::unique_ptr<depth::FrameSource> OpenSource(const SourceArguments& arguments, bool quiet);

std::chrono::milliseconds Milliseconds(double seconds);

}  // namespace ossa::commands
