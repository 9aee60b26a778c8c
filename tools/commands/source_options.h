#pragma once
#include <chrono>
#include <functional>
#include <memory>
#include <set>
#include <string>
#include <string_view>

#include "depth/sensor/frame_source.h"
#include "tools/tracker/tracker.h"

namespace CLI {
class App;
}

namespace ossa::commands {

/// A SOURCE and how it is read, the same for all commands.
struct SourceArguments {
  std::string name, camera, depth_format = "plain";
  double depth_scale = 0.0;  // units per metre; 0: not given
  double fps = 0.0;          // 0: not given
  bool mirrored = false;     // the images are mirrored
  std::string rotate = "auto";
  std::shared_ptr<std::set<std::string>> printed = std::make_shared<std::set<std::string>>();
  // The preset chosen by the images' size; "": the camera is stated.
  std::shared_ptr<std::string> guessed = std::make_shared<std::string>();
  double wait_s = 0.0;
  double patience_s = 5.0;
};

/// Whether a SOURCE of this name is a device, or plays like one, and not a recording.
bool IsDevice(std::string_view source);

/// A device, or images that another program sends (depth::IsStream).
bool IsLive(const std::string& source);

/// Adds SOURCE, --camera, --depth-scale, --depth-format, --fps, --mirrored and --rotate.
void AddSourceOptions(CLI::App& app, SourceArguments& arguments);
tracker::Turn ChooseTurn(const SourceArguments& arguments);
/// For a folder of images without a stated camera: selects a camera with a narrower view
/// (depth::NarrowerCameras) if people have a much higher confidence with it, and prints that unless
/// quiet. `options` is called only where there is an alternative.
void FindCamera(SourceArguments& arguments, const std::function<tracker::TrackerOptions()>& options,
                bool quiet);
/// Throws Contradiction for a --depth-scale of a --depth-format that has none.
void CheckDepthScale(const SourceArguments& arguments);
/// With --rotate auto, for a recording (`source`, which is not consumed): finds the image rotation
/// before tracking, and prints it unless upright.
void FindUpright(tracker::Tracker& tracker, const depth::FrameSource& source,
                 const SourceArguments& arguments, bool quiet);
/// Adds --wait and --patience, for devices.
void AddDeviceOptions(CLI::App& app, SourceArguments& arguments);

/// Prints a line for each of them that was given for a recording, unless quiet.
void PrintUnreadDeviceOptions(const CLI::App& app, const SourceArguments& arguments, bool quiet);

/// Opens the source; waits for a device as --wait requests, printing that once unless quiet, until
/// Ctrl-C. Assumptions and skipped frames are printed unless quiet, losses always. Throws
/// UsageError for an invalid --camera.
std::unique_ptr<depth::FrameSource> OpenSource(const SourceArguments& arguments, bool quiet);

std::chrono::milliseconds Milliseconds(double seconds);

}  // namespace ossa::commands
