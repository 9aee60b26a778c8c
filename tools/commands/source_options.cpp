#include "tools/commands/source_options.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>

#include "depth/base/error.h"
#include "depth/image/camera_io.h"
#include "tools/commands/command.h"
#include "tools/commands/process.h"

namespace ossa::commands {
namespace {

constexpr double kLongest_s = 1e6;  // eleven days

std::function<bool()> KeepWaitingFor(const std::string& source, bool quiet) {
  return [source, said = quiet]() mutable {
    if (!said) Say(fmt::format("waiting for {} (Ctrl-C ends it)\n", source));
    said = true;
    return !Interrupted();
  };
}

}  // namespace

void AddSourceOptions(CLI::App& app, SourceArguments& arguments) {
  app.add_option(
         "SOURCE", arguments.name,
         "openni: (first device), openni:URI, FILE.oni, a 16-bit PNG or a folder of them, or a "
         "DATASET; openni:ossa://PATH plays what is recorded as a live device")
      ->required();
  app.add_option("--camera", arguments.camera, "kinect-v1 or fx,fy,cx,cy in pixels");
}

void AddDeviceOptions(CLI::App& app, SourceArguments& arguments) {
  app.add_option("--wait", arguments.wait_s,
                 "wait so many seconds for a device to be plugged in (default 0)")
      ->check(CLI::Range(0.0, kLongest_s));
  app.add_option("--patience", arguments.patience_s,
                 "give up on a device that is unplugged or silent for so many seconds (default 5)")
      ->check(CLI::Range(1e-3, kLongest_s));
}

depth::SourceOptions CameraOptions(const SourceArguments& arguments) {
  depth::SourceOptions options;
  try {
    if (!arguments.camera.empty()) options.camera = depth::ParseCamera(arguments.camera);
  } catch (const InputError& error) {
    throw UsageError(error.what());
  }
  return options;
}

std::unique_ptr<depth::FrameSource> OpenSource(const SourceArguments& arguments, bool quiet) {
  depth::SourceOptions options = CameraOptions(arguments);
  options.device_wait = Milliseconds(arguments.wait_s);
  if (arguments.wait_s > 0) options.keep_waiting = KeepWaitingFor(arguments.name, quiet);
  return depth::OpenSource(arguments.name, options);
}

std::chrono::milliseconds Milliseconds(double seconds) {
  return std::chrono::milliseconds(static_cast<int64_t>(seconds * 1000.0));
}

}  // namespace ossa::commands
