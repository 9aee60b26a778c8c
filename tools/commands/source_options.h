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

/// A SOURCE and how it is read, the same for every command that has one.
struct SourceArguments {
  std::string name, camera, depth_format = "plain";
  double depth_scale = 0.0;  // units to the metre; 0: not said
  double fps = 0.0;          // 0: not said
  bool mirrored = false;     // images as a mirror shows them
  std::string rotate = "auto";
  std::shared_ptr<std::set<std::string>> said = std::make_shared<std::set<std::string>>();
  // Whose camera it was taken for by its images' size alone: a preset's name; "": it is stated.
  std::shared_ptr<std::string> guessed = std::make_shared<std::string>();
  double wait_s = 0.0;
  double patience_s = 5.0;
};

/// Whether a SOURCE of that name is a device, or plays as one, and no recording.
bool IsDevice(std::string_view source);

/// SOURCE, --camera, --depth-scale, --depth-format, --fps, --mirrored and --rotate.
void AddSourceOptions(CLI::App& app, SourceArguments& arguments);
tracker::Turn ChooseTurn(const SourceArguments& arguments);
/// Before a folder of images is tracked that does not say its camera: takes one of a narrower view
/// (depth::NarrowerCameras) where people are seen far more surely by it, and says so unless quiet.
/// `options` of the tracker are asked for where there is a choice.
void FindCamera(SourceArguments& arguments, const std::function<tracker::TrackerOptions()>& options,
                bool quiet);
/// With --rotate auto, before a recording (`source`, which it does not read) is tracked: finds
/// which way up its camera is, and says so unless it stands.
void FindUpright(tracker::Tracker& tracker, const depth::FrameSource& source,
                 const SourceArguments& arguments, bool quiet);
/// --wait and --patience, for what a device may do.
void AddDeviceOptions(CLI::App& app, SourceArguments& arguments);

/// Waits for a device as --wait asks, says so once unless quiet, and gives up at Ctrl-C. What was
/// assumed or passed over is said unless quiet, what was lost in any case. Throws UsageError for a
/// --camera that is none.
std::unique_ptr<depth::FrameSource> OpenSource(const SourceArguments& arguments, bool quiet);

std::chrono::milliseconds Milliseconds(double seconds);

}  // namespace ossa::commands
