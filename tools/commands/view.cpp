#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <filesystem>
#include <memory>
#include <string>
#include <thread>

#include "depth/sensor/frame_source.h"
#include "recon/files/skeleton_io.h"
#include "recon/methods/reconstructor.h"
#include "tools/commands/command.h"
#include "tools/commands/commands.h"
#include "tools/commands/method_options.h"
#include "tools/commands/process.h"
#include "tools/commands/source_options.h"
#include "tools/commands/warnings.h"
#include "tools/tracker/skeleton_record.h"
#include "tools/tracker/tracker.h"
#include "tools/viewer/viewer.h"

namespace ossa::commands {
namespace {

using Clock = std::chrono::steady_clock;

struct ViewOptions {
  SourceArguments source;
  tracker::ModelFiles files;
  tracker::TrackerOptions tracker;
  int port = 8080;  // by convention, an HTTP port that needs no rights
  bool once = false;
};

// Shows a recording at its own speed: waits until the time of the frame has come.
class Clockwork {
 public:
  void WaitFor(double time_s) {
    if (time_s < last_s_ || time_s - last_s_ > 1.0) start_ = Clock::now() - Seconds(time_s);
    last_s_ = time_s;
    std::this_thread::sleep_until(start_ + Seconds(time_s));
  }
  // For a frame's time, as every other; a recording of one frame would begin anew without end.
  static void ShowTheLast() { std::this_thread::sleep_for(Seconds(1.0 / 30.0)); }

 private:
  static Clock::duration Seconds(double s) {
    return std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(s));
  }
  Clock::time_point start_ = Clock::now();
  double last_s_ = -1e9;
};

void SayWhere(const viewer::Viewer& viewer) {
  Say(fmt::format("watch at http://127.0.0.1:{}/ (Ctrl-C ends)\n", viewer.port()));
}

void ShowSkeletons(const ViewOptions& options) {
  const recon::SkeletonSequence sequence = recon::ReadSkeletons(options.source.name);
  SayWarnings("view", sequence.warnings);
  viewer::Viewer viewer(options.port);
  SayWhere(viewer);
  depth::DepthFrame blank;
  blank.depth_mm.assign(
      static_cast<size_t>(blank.camera.width) * static_cast<size_t>(blank.camera.height), 0);
  Clockwork clockwork;
  do {
    for (const recon::SkeletonFrame& frame : sequence.frames) {
      if (Interrupted()) return;
      clockwork.WaitFor(frame.time_s);
      viewer.Show(blank, frame);
    }
    clockwork.ShowTheLast();
  } while (!options.once && !Interrupted());
}

void ShowSource(const ViewOptions& options) {
  auto source = OpenSource(options.source, false);
  tracker::TrackerOptions with = options.tracker;
  with.models = tracker::ModelSet::Load(options.files, with.method);
  tracker::Tracker tracker(with);
  FindUpright(tracker, *source, options.source, false);
  viewer::Viewer viewer(options.port);
  SayWhere(viewer);
  for (;;) {
    Clockwork clockwork;
    while (!Interrupted()) {
      const depth::ReadResult read = source->Read(std::chrono::milliseconds(100));
      if (read.status == depth::ReadStatus::kEnd) break;
      if (read.status != depth::ReadStatus::kFrame) continue;
      if (!source->is_live()) clockwork.WaitFor(read.frame.time_s);
      viewer.Show(read.frame, tracker::ToRecord(tracker.Track(read.frame)));
    }
    if (options.once || Interrupted()) return;
    clockwork.ShowTheLast();
    source = OpenSource(options.source, true);
  }
}

}  // namespace

int View(int argc, char** argv) {
  CLI::App app(
      "Show a SOURCE being tracked, or a skeleton file given as SOURCE, in a browser on this "
      "machine");
  ViewOptions options;
  AddSourceOptions(app, options.source);
  AddRotateOption(app, options.source);
  app.add_option("--port", options.port, "on 127.0.0.1 (default 8080, 0: any free one)")
      ->check(CLI::Range(0, 65535));
  app.add_option("--model", options.files.forest, "forest model, .ossa (default: the shipped one)");
  app.add_option("--database", options.files.database, "posture database, .ossadb");
  app.add_option("--method", options.tracker.method, "how postures are completed (default best)")
      ->check(CLI::IsMember(recon::ReconstructionMethods()));
  app.add_option("--learned", options.files.learned, ".ossagp, for the methods that learn");
  app.add_flag("--once", options.once, "end with the recording instead of starting over");
  Parse(app, argc, argv);
  CheckRead(app, options.tracker.method, false);
  CheckLearned(options.tracker.method, options.files.learned);
  options.tracker.turn = TurnOf(options.source);
  const std::string& what = options.source.name;
  if (what.starts_with("openni:") || std::filesystem::is_directory(what) ||
      depth::IsRecording(what)) {
    ShowSource(options);
  } else {
    ShowSkeletons(options);
  }
  return 0;
}

}  // namespace ossa::commands
