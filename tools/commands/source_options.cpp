#include "tools/commands/source_options.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <set>
#include <system_error>

#include "depth/base/error.h"
#include "depth/base/one_line.h"
#include "depth/image/camera_io.h"
#include "depth/sensor/depth_coding.h"
#include "tools/commands/command.h"
#include "tools/commands/process.h"
#include "tools/tracker/camera_search.h"

namespace ossa::commands {
namespace {

constexpr double kLongest_s = 1e6;  // eleven days; a bound

std::function<bool()> KeepWaitingFor(const std::string& source, bool quiet) {
  return [source, said = quiet]() mutable {
    if (!said) Say(fmt::format("waiting for {} (Ctrl-C ends it)\n", source));
    said = true;
    return !Interrupted();
  };
}

// What a source has to say; of two that are opened in one run, once.
void SayNote(depth::NoteKind kind, const std::string& text, bool quiet,
             std::set<std::string>& said) {
  if (quiet && kind == depth::NoteKind::kInfo) return;
  if (said.insert(text).second) Say(text + "\n");
}

depth::SourceOptions DepthOptions(const SourceArguments& arguments, bool quiet) {
  depth::SourceOptions options;
  try {
    if (!arguments.camera.empty()) options.camera = depth::ParseCamera(arguments.camera);
    const depth::DepthCoding coding = depth::ParseDepthFormat(arguments.depth_format);
    options.depth_format = coding.format;
    options.inverted_from = coding.inverted_from;
  } catch (const InputError& error) {
    throw UsageError(error.what());
  }
  if (arguments.depth_scale > 0) options.depth_scale = arguments.depth_scale;
  if (arguments.fps > 0) options.fps = arguments.fps;
  options.note = [quiet, said = arguments.said](depth::NoteKind kind, const std::string& text) {
    SayNote(kind, OnOneLine(text), quiet, *said);
  };
  return options;
}

}  // namespace

void AddSourceOptions(CLI::App& app, SourceArguments& arguments) {
  app.add_option(
         "SOURCE", arguments.name,
         "openni: (first device), openni:URI, FILE.oni, FILE.mkv, FILE.bag, a 16-bit PNG or a "
         "folder "
         "of them, or a DATASET; openni:ossa://PATH plays what is recorded as a live device")
      ->required();
  std::string presets;
  for (const std::string_view name : depth::CameraPresetNames()) presets.append(name).append(", ");
  app.add_option("--camera", arguments.camera,
                 presets +
                     "or fx,fy,cx,cy in pixels (default: the source's own, else by its "
                     "images' size)");
  app.add_option("--depth-scale", arguments.depth_scale,
                 "units to the metre of a recording's depths (default: its own, else 1000, "
                 "millimetres)")
      ->check(CLI::Range(1e-3, 1e6));
  app.add_option("--depth-format", arguments.depth_format,
                 "what the numbers are: plain, swapped (bytes), inverted (65535 stands for 0), "
                 "inverted:FROM (FROM does) or disparity (Kinect v1, 11 bits)");
  app.add_option("--fps", arguments.fps,
                 "frames a second of a recording (default: its own times, else 30)")
      ->check(CLI::Range(1e-3, 1e4));
  app.add_option("--rotate", arguments.rotate,
                 "degrees by which the images must be turned clockwise for people to stand in "
                 "them, or auto (default); what comes out stays in the camera's own space")
      ->check(CLI::IsMember({"auto", "0", "90", "180", "270"}));
}

bool IsDevice(std::string_view source) { return source.starts_with("openni:"); }

tracker::Turn ChooseTurn(const SourceArguments& arguments) {
  if (arguments.rotate == "auto") return tracker::Turn::kAuto;
  constexpr int kQuarter_deg = 90;  // by definition
  return static_cast<tracker::Turn>(std::stoi(arguments.rotate) / kQuarter_deg);
}

namespace {

// Whose camera is guessed by its images' size.
std::optional<depth::CameraGuess> GuessedCamera(const SourceArguments& arguments) {
  std::optional<depth::CameraGuess> guessed;
  depth::SourceOptions options = DepthOptions(arguments, true);
  options.guessed = [&guessed](const depth::CameraGuess& guess) { guessed = guess; };
  depth::OpenSource(arguments.name, options);
  return guessed;
}

// Stills far apart: a quarter of a minute of a recording, all of a few photographs.
void LookAtSome(depth::FrameSource& source, tracker::CameraSearch& search) {
  constexpr int64_t kMostFrames = 480, kMostStep = 15;  // by hand
  const int64_t step = std::clamp(source.frame_count().value_or(0) / 16, int64_t{1}, kMostStep);
  for (int64_t n = 0; n < kMostFrames && !search.is_sure() && !Interrupted();) {
    depth::ReadResult read = source.Read(std::chrono::milliseconds(100));
    if (read.status == depth::ReadStatus::kEnd) return;
    if (read.status == depth::ReadStatus::kFrame && n++ % step == 0) {
      search.Look(std::move(read.frame));
    }
  }
}

std::string CameraText(const depth::CameraGuess& guess) {
  if (!guess.preset.empty()) return std::string(guess.preset);
  const depth::Camera& c = guess.camera;
  return fmt::format("{:.1f},{:.1f},{:.1f},{:.1f}", c.fx, c.fy, c.cx, c.cy);
}

}  // namespace

void FindCamera(SourceArguments& arguments, const std::function<tracker::TrackerOptions()>& options,
                bool quiet) {
  const std::filesystem::path path = arguments.name;
  std::error_code unknown;  // told of when its turn comes
  const bool has_images = std::filesystem::is_regular_file(path, unknown)
                              ? path.extension() != ".oni" && path.extension() != ".mkv"
                              : std::filesystem::is_directory(path, unknown);
  if (!arguments.camera.empty() || !has_images) return;
  try {
    const auto guess = GuessedCamera(arguments);
    if (!guess) return;
    const auto others = depth::NarrowerCameras(guess->camera.width, guess->camera.height);
    if (others.empty()) return;
    std::vector<depth::Camera> cameras = {guess->camera};
    for (const depth::CameraGuess& other : others) cameras.push_back(other.camera);
    tracker::CameraSearch search(cameras, options());
    LookAtSome(*depth::OpenSource(arguments.name, DepthOptions(arguments, true)), search);
    const size_t best = search.Best();
    if (best == 0) return;
    arguments.camera = CameraText(others[best - 1]);
    if (quiet) return;
    Say(
        fmt::format("{}: no camera is stated; people in its images of {}x{} are far surer as "
                    "--camera {} (f {:.0f} px) sees them than as a {} does (f {:.0f} px): taken "
                    "for that\n",
                    OnOneLine(arguments.name), guess->camera.width, guess->camera.height,
                    arguments.camera, others[best - 1].camera.fx, guess->preset, guess->camera.fx));
  } catch (const InputError&) {  // told of when its turn comes
  }
}

void FindUpright(tracker::Tracker& tracker, const depth::FrameSource& source,
                 const SourceArguments& arguments, bool quiet) {
  if (arguments.rotate != "auto" || source.is_live()) return;
  try {
    tracker.FindUpright(*OpenSource(arguments, true), [] { return !Interrupted(); });
  } catch (const InputError&) {  // told of when its turn comes
  }
  if (tracker.quarter_turns() == 0 || quiet) return;
  Say(
      fmt::format("{}: people stand in its images once these are turned by {} degrees clockwise: "
                  "--rotate says otherwise\n",
                  OnOneLine(arguments.name), 90 * tracker.quarter_turns()));
}

void AddDeviceOptions(CLI::App& app, SourceArguments& arguments) {
  app.add_option("--wait", arguments.wait_s,
                 "wait so many seconds for a device to be plugged in (default 0)")
      ->check(CLI::Range(0.0, kLongest_s));
  app.add_option("--patience", arguments.patience_s,
                 "give up on a device that is unplugged or silent for so many seconds (default 5)")
      ->check(CLI::Range(1e-3, kLongest_s));
}

std::unique_ptr<depth::FrameSource> OpenSource(const SourceArguments& arguments, bool quiet) {
  depth::SourceOptions options = DepthOptions(arguments, quiet);
  options.device_wait = Milliseconds(arguments.wait_s);
  if (arguments.wait_s > 0) options.keep_waiting = KeepWaitingFor(arguments.name, quiet);
  return depth::OpenSource(arguments.name, options);
}

std::chrono::milliseconds Milliseconds(double seconds) {
  return std::chrono::milliseconds(static_cast<int64_t>(seconds * 1000.0));
}

}  // namespace ossa::commands
