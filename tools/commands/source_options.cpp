#include "tools/commands/source_options.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <set>

#include "depth/base/error.h"
#include "depth/base/one_line.h"
#include "depth/image/camera_io.h"
#include "depth/sensor/depth_coding.h"
#include "tools/commands/command.h"
#include "tools/commands/process.h"
#include "tools/tracker/camera_search.h"

namespace ossa::commands {
namespace {

constexpr double kLongest_s = 1e6;  // eleven days; an upper bound

std::function<bool()> MakeWaitCallback(const std::string& source, bool quiet) {
  return [source, printed = quiet]() mutable {
    if (!printed) PrintError(fmt::format("waiting for {} (Ctrl-C ends it)\n", source));
    printed = true;
    return !Interrupted();
  };
}

// Prints a source's notes; those of a source that is opened twice in one run once.
void PrintNote(depth::NoteKind kind, const std::string& text, bool quiet,
               std::set<std::string>& printed) {
  if (quiet && kind == depth::NoteKind::kInfo) return;
  if (printed.insert(text).second) PrintError(text + "\n");
}

depth::SourceOptions DepthOptions(const SourceArguments& arguments, bool quiet) {
  CheckDepthScale(arguments);
  depth::SourceOptions options;
  const bool is_file = depth::IsCameraFile(arguments.camera);
  if (is_file) options.camera = depth::ReadCameraFile(arguments.camera);
  try {
    if (!arguments.camera.empty() && !is_file)
      options.camera = depth::ParseCamera(arguments.camera);
    const depth::DepthCoding coding = depth::ParseDepthFormat(arguments.depth_format);
    options.depth_format = coding.format;
    options.inverted_from = coding.inverted_from;
    if (arguments.depth_scale > 0) options.depth_scale = arguments.depth_scale;
  } catch (const InputError& error) {
    throw UsageError(error.what());
  }
  if (arguments.fps > 0) options.fps = arguments.fps;
  options.mirrored = arguments.mirrored;
  options.guessed = [guessed = arguments.guessed](const depth::CameraGuess& guess) {
    *guessed = guess.preset;
  };
  options.note = [quiet, printed = arguments.printed](depth::NoteKind kind,
                                                      const std::string& text) {
    PrintNote(kind, OnOneLine(text), quiet, *printed);
  };
  return options;
}

}  // namespace

void CheckDepthScale(const SourceArguments& arguments) {
  if (arguments.depth_format != "disparity" || !(arguments.depth_scale > 0)) return;
  throw Contradiction("--depth-scale: expected none with --depth-format disparity");
}

void AddSourceOptions(CLI::App& app, SourceArguments& arguments) {
  app.add_option(
         "SOURCE", arguments.name,
         "openni: (first device), openni:URI, FILE.oni, FILE.xef, FILE.mkv, FILE.bag, FILE.db3, "
         "FILE.mcap, arrays (.npy, .npz, .mat, .h5), a 16-bit PNG, TIFF or PGM or a folder "
         "of them, a DATASET, or - (PGM images on standard input); openni:ossa://PATH plays a "
         "recording as a live device")
      ->required();
  std::string presets;
  for (const std::string_view name : depth::CameraPresetNames()) presets.append(name).append(", ");
  app.add_option("--camera", arguments.camera,
                 presets +
                     "or fx,fy,cx,cy in pixels, or a file: camera.json, a calibration of OpenCV, "
                     "ROS, Kalibr or COLMAP (.yaml, .xml, .json, .txt), or the camera matrix alone "
                     "(.txt, .npy) (default: the source's own, else by the image size)");
  app.add_option("--depth-scale", arguments.depth_scale,
                 "depth units per metre of a recording (default: its own, else 1000, millimetres)")
      ->check(CLI::Range(1e-3, 1e6));
  app.add_option(
      "--depth-format", arguments.depth_format,
      "encoding of the depths: plain (default), swapped (bytes), inverted (65535 stands for 0 mm), "
      "inverted:FROM (FROM stands for 0 mm) or disparity (Kinect v1, 11 bits)");
  app.add_option("--fps", arguments.fps,
                 "frame rate of a recording, Hz (default: its own times, else 30)")
      ->check(CLI::Range(1e-3, 1e4));
  app.add_flag(
      "--mirrored", arguments.mirrored,
      "the images are mirrored, as Kinect SDKs and libfreenect2 deliver them: left and right "
      "are exchanged before anything else");
  app.add_option("--rotate", arguments.rotate,
                 "degrees by which the images must be rotated clockwise for people to stand "
                 "upright, or auto (default); results stay in the camera's own space")
      ->check(CLI::IsMember({"auto", "0", "90", "180", "270"}));
}

bool IsDevice(std::string_view source) { return source.starts_with("openni:"); }

bool IsLive(const std::string& source) { return IsDevice(source) || depth::IsStream(source); }

tracker::Turn ChooseTurn(const SourceArguments& arguments) {
  if (arguments.rotate == "auto") return tracker::Turn::kAuto;
  constexpr int kQuarter_deg = 90;  // by definition
  return static_cast<tracker::Turn>(std::stoi(arguments.rotate) / kQuarter_deg);
}

void FindCamera(SourceArguments& arguments, const std::function<tracker::TrackerOptions()>& options,
                bool quiet) {
  if (!arguments.camera.empty()) return;
  try {
    const auto finding = tracker::FindNarrowerCamera(arguments.name, DepthOptions(arguments, true),
                                                     options, [] { return !Interrupted(); });
    if (!finding) return;
    arguments.camera = tracker::CameraText(finding->found);
    if (!quiet) PrintError(OnOneLine(arguments.name) + ": " + Describe(*finding) + "\n");
  } catch (const InputError&) {  // reported when it is opened
  }
}

void FindUpright(tracker::Tracker& tracker, const depth::FrameSource& source,
                 const SourceArguments& arguments, bool quiet) {
  if (arguments.rotate != "auto" || source.is_live()) return;
  try {
    tracker.FindUpright(*OpenSource(arguments, true), [] { return !Interrupted(); });
  } catch (const InputError&) {  // reported when it is opened
  }
  if (tracker.quarter_turns() == 0 || quiet) return;
  PrintError(
      fmt::format("{}: its images are rotated by {} degrees clockwise, so that people stand "
                  "upright: --rotate sets the rotation\n",
                  OnOneLine(arguments.name), 90 * tracker.quarter_turns()));
}

void AddDeviceOptions(CLI::App& app, SourceArguments& arguments) {
  app.add_option("--wait", arguments.wait_s,
                 "seconds to wait for a device to be plugged in (default 0)")
      ->check(CLI::Range(0.0, kLongest_s));
  app.add_option("--patience", arguments.patience_s,
                 "seconds after which a device that is unplugged or silent is given up (default 5)")
      ->check(CLI::Range(1e-3, kLongest_s));
}

// No refusal: a file of defaults may have them for devices.
void PrintUnreadDeviceOptions(const CLI::App& app, const SourceArguments& arguments, bool quiet) {
  if (quiet || IsDevice(arguments.name)) return;
  for (const std::string option : {"--wait", "--patience"}) {
    const bool is_read = option == "--patience" && depth::IsStream(arguments.name);
    if (app.count(option) == 0 || is_read) continue;
    PrintError(fmt::format("ossa: {} is not read for a recording\n", option));
  }
}

std::unique_ptr<depth::FrameSource> OpenSource(const SourceArguments& arguments, bool quiet) {
  depth::SourceOptions options = DepthOptions(arguments, quiet);
  options.device_wait = Milliseconds(arguments.wait_s);
  options.keep_waiting = MakeWaitCallback(arguments.name, quiet || !(arguments.wait_s > 0));
  return depth::OpenSource(arguments.name, options);
}

std::chrono::milliseconds Milliseconds(double seconds) {
  return std::chrono::milliseconds(static_cast<int64_t>(seconds * 1000.0));
}

}  // namespace ossa::commands
