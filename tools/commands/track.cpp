#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "depth/base/atomic_file.h"
#include "depth/base/error.h"
#include "depth/sensor/frame_source.h"
#include "recon/methods/reconstructor.h"
#include "recon/refine/refinement_cascade.h"
#include "tools/commands/checks.h"
#include "tools/commands/command.h"
#include "tools/commands/commands.h"
#include "tools/commands/decision_trace.h"
#include "tools/commands/mechanics_options.h"
#include "tools/commands/method_options.h"
#include "tools/commands/outputs.h"
#include "tools/commands/process.h"
#include "tools/commands/source_options.h"
#include "tools/commands/track_options.h"
#include "tools/commands/track_outputs.h"
#include "tools/commands/track_several.h"
#include "tools/commands/view_options.h"
#include "tools/commands/warnings.h"
#include "tools/stream/sender.h"
#include "tools/tracker/run_stats.h"
#include "tools/tracker/shipped.h"
#include "tools/viewer/viewer.h"

namespace ossa::commands {
namespace {

using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;

enum class Ending { kComplete, kUnplugged, kSilent, kInterrupted };

struct Run {
  tracker::RunStats stats;
  int64_t dropped = 0;
  std::optional<int64_t> of;  // frames to track
  int64_t lost_gaps = 0;      // number of reconnections of the device
  bool somebody = false;      // a person was tracked in some frame
  Ending ending = Ending::kComplete;
  std::string failure;  // of the source; frames before it are kept
  std::optional<DiskFull> full;
};

std::optional<int64_t> FramesWanted(const depth::FrameSource& source, const TrackOptions& options) {
  const std::optional<int64_t> known = source.frame_count();
  if (options.frames == 0) return known;
  return std::min(options.frames, known.value_or(options.frames));
}

/// The outputs of tracking. Images wait for their bodies, which the lag delays.
struct Destinations {
  const TrackOptions& options;
  tracker::Tracker& tracker;
  SkeletonOutput& output;
  DecisionTrace& trace;
  Pictures& pictures;
  PersonKeeper& person;
  stream::Sender& sender;
  viewer::Viewer* viewer = nullptr;
  std::deque<depth::DepthFrame> waiting{};

  void Deliver(const tracker::BodyFrame& bodies, Run& run) {
    run.stats.Add(bodies.ms);
    run.somebody = run.somebody || !bodies.bodies.empty();
    sender.Send(bodies);  // first, because receivers are live
    output.Write(bodies);
    person.Take(bodies);
    trace.Write(bodies);
    pictures.Take(waiting.front(), bodies);
    if (viewer != nullptr) {
      viewer::DisplayFrame display = viewer::MakeDisplayFrame(waiting.front(), bodies);
      display.dropped = run.dropped;
      display.is_upright = tracker.quarter_turns() == 0;
      display.latency_ms = bodies.ms.total;
      display.solids = viewer::SolidsOf(bodies, options.mechanics.follows());
      viewer->Show(std::move(display));
    }
    waiting.pop_front();
  }
};

void PrintMount(bool hangs) {
  PrintError(
      hangs
          ? "ossa track: the camera looks down from the ceiling: people are found by their heads, "
            "joints by body_ceiling.ossa (--mount level: it does not)\n"
          : "ossa track: the camera does not look down from the ceiling after all (--mount "
            "ceiling: it does)\n");
}

void TrackToEnd(depth::FrameSource& source, tracker::Tracker& tracker, const TrackOptions& options,
                Destinations& to, Run& run) {
  Progress progress("tracking", options.quiet);
  const auto known = static_cast<double>(source.frame_count().value_or(0));
  run.of = FramesWanted(source, options);
  auto last_frame_at = Clock::now();
  bool gone = false;
  bool hangs = options.tracker.mount == tracker::Mount::kCeiling;
  int64_t tracked = 0;
  while (!Interrupted()) {
    depth::ReadResult read = source.Read(milliseconds(100));
    run.dropped += read.dropped;
    if (read.status == depth::ReadStatus::kEnd) return;
    if (read.status != depth::ReadStatus::kFrame) {
      gone = gone || read.status == depth::ReadStatus::kDisconnected;
      const std::chrono::duration<double> silence = Clock::now() - last_frame_at;
      if (source.is_live() && silence.count() > options.source.patience_s) {
        run.ending = gone ? Ending::kUnplugged : Ending::kSilent;
        return;
      }
      continue;
    }
    last_frame_at = Clock::now();
    run.lost_gaps += gone ? 1 : 0;
    gone = false;
    const auto bodies = tracker.TrackWithLag(read.frame);
    PrintWarning("track", options.source.name, tracker);
    const bool hung = std::exchange(hangs, tracker.mount() == tracker::Mount::kCeiling);
    if (hangs != hung && !options.quiet) PrintMount(hangs);
    ++tracked;
    to.waiting.push_back(std::move(read.frame));
    if (bodies) to.Deliver(*bodies, run);
    if (known > 0 && bodies) {
      progress.Update(static_cast<double>(tracked), known,
                      fmt::format("{} people", bodies->bodies.size()));
    }
    if (options.frames > 0 && tracked >= options.frames) return;
  }
  const bool has_end = !source.is_live() && tracked != run.of;
  if (has_end) run.ending = Ending::kInterrupted;
}

/// Delivers frames held by the lag also after the source failed.
void TrackAvailableFrames(depth::FrameSource& source, tracker::Tracker& tracker,
                          const TrackOptions& options, Destinations& to, Run& run) {
  try {
    TrackToEnd(source, tracker, options, to, run);
  } catch (const DiskFull&) {
    throw;  // of an output, not of the source
  } catch (const InputError& error) {
    run.failure = error.what();
  }
  while (const auto held = tracker.DrainLag()) to.Deliver(*held, run);
}

/// Finishes all outputs; one that did not fit on the disk throws.
void TrackAll(depth::FrameSource& source, tracker::Tracker& tracker, const TrackOptions& options,
              Destinations& to, Run& run) {
  try {
    TrackAvailableFrames(source, tracker, options, to, run);
  } catch (const DiskFull& full) {
    run.full = full;
  }
}

// Bone lengths over the whole recording, for which it is tracked once more.
std::map<int, recon::BoneLengths> MeasureBones(const TrackOptions& options) {
  const auto source = OpenSource(options.source, options.quiet);
  if (source->is_live()) {
    throw UsageError(
        fmt::format("--bones recording: {}: expected a recording, found a device or a pipe",
                    options.source.name));
  }
  tracker::TrackerOptions measuring = options.tracker;
  measuring.keep_parts = measuring.trace = false;
  tracker::Tracker tracker(measuring);
  FindUpright(tracker, *source, options.source, options.quiet);
  Progress progress("measuring bones", options.quiet);
  const auto known = static_cast<double>(source->frame_count().value_or(0));
  std::map<int, recon::BoneLengths> bones_m;
  int64_t frames = 0;
  tracker.Run(
      *source,
      [&](const tracker::BodyFrame& bodies) {
        for (const tracker::Body& body : bodies.bodies) {
          if (body.bones_m) bones_m[body.id] = *body.bones_m;
        }
        ++frames;
        if (known > 0) progress.Update(static_cast<double>(frames), known);
        return !Interrupted() && frames != options.frames;
      },
      [] { return !Interrupted(); });
  if (Interrupted()) {
    throw InputError("track: interrupted while bones were measured; nothing was written");
  }
  return bones_m;
}

void CheckStatsWritable(const TrackOptions& options) {
  if (options.json_stats.empty() || options.json_stats == "-") return;
  AtomicFile::CheckWritable(options.json_stats);
}

void Report(const TrackOptions& options, const Run& run) {
  if (options.json_stats == "-") {
    fmt::print("{}", run.stats.Json(run.dropped));
  } else if (!options.json_stats.empty()) {
    WriteText(options.json_stats, run.stats.Json(run.dropped));
  }
  if (run.ending == Ending::kUnplugged || run.ending == Ending::kSilent) {
    const char* what = run.ending == Ending::kUnplugged ? "unplugged" : "delivers no frames";
    PrintError(fmt::format("ossa track: {}: the device {} for {:g} s: ending after {} frames\n",
                           options.source.name, what, options.source.patience_s,
                           run.stats.frames()));
  }
  if (!options.quiet && options.json_stats != "-") {
    fmt::print("{} frames, {} dropped, {} reconnections\n", run.stats.frames(), run.dropped,
               run.lost_gaps);
  }
}

/// Objects of a scene need a floor: prints a line if none was detected.
void PrintMissingFloor(tracker::Tracker& tracker, const TrackOptions& options) {
  if (tracker.scene() == nullptr || tracker.scene()->has_floor()) return;
  PrintError(
      fmt::format("ossa track: {}: no floor was seen, so that no object appeared: expected "
                  "floor = [a, b, c, d] in the file\n",
                  options.mechanics.scene));
}

/// Without people the recording is empty or was read with wrong options: the images do not tell
/// which.
void PrintNobodyFound(const TrackOptions& options, const depth::Camera& camera, const Run& run) {
  if (options.quiet || run.somebody || run.stats.frames() == 0) return;
  PrintError(
      fmt::format("ossa track: {}: nobody was found, by a camera of f {:.0f} px: if somebody is in "
                  "view, see whether --camera, --depth-scale and --rotate are right\n",
                  options.source.name, camera.fx));
}

void CheckFrames(const TrackOptions& options, const Run& run) {
  if (run.stats.frames() > 0) return;
  if (Interrupted()) {
    throw InputError("track: interrupted before the first frame; nothing was written");
  }
  throw InputError(options.source.name + ": no frame came");
}

InputError InterruptedEarly(const TrackOptions& options, const Run& run) {
  const std::string where = options.out.empty() ? " were tracked" : " are in " + options.out;
  return InputError(fmt::format("{}: interrupted: {}{}", options.source.name,
                                FramesText(run.stats.frames(), run.of), where));
}

/// Known shapes and bones of people before the first frame.
void SetKnownPeople(TrackOptions& options) {
  options.tracker.shapes = ReadPeople(options.fit, *options.tracker.models);
  if (options.bones.of_recording()) options.tracker.bones_m = MeasureBones(options);
}

std::unique_ptr<viewer::Viewer> OpenViewer(const TrackOptions& options) {
  if (!options.view) return nullptr;
  viewer::ViewerOptions page = PageOptions(options.page);
  page.name = options.source.name;
  page.forest = options.tracker.models->forest;
  page.body = LoadSkin(options.files.surface, options.write.mesh);
  auto viewer = std::make_unique<viewer::Viewer>(page);
  PrintUrls(*viewer);
  return viewer;
}

/// Throws InputError if nothing was tracked.
void CheckWorthKeeping(const TrackOptions& options, const Run& run) {
  if (!run.failure.empty() && run.stats.frames() == 0) throw InputError(run.failure);
  CheckFrames(options, run);
}

/// Throws InputError if all is written but the recording was not tracked to its end.
void CheckComplete(const TrackOptions& options, const Run& run) {
  if (!run.failure.empty()) {
    const std::string frames = FramesText(run.stats.frames(), run.of);
    throw InputError(
        options.out.empty()
            ? fmt::format("{}; the {} before it were tracked", run.failure, frames)
            : fmt::format("{}; the {} before it are in {}", run.failure, frames, options.out));
  }
  if (run.ending == Ending::kInterrupted) throw InterruptedEarly(options, run);
}

/// Finishes all outputs, even if some fail.
void FinishAll(Destinations& to, const depth::Camera& camera, const Run& run) {
  DoEach("track",
         {[&] { to.output.Finish(); }, [&] { to.pictures.Finish(); },
          [&] { Report(to.options, run); }, [&] { PrintNobodyFound(to.options, camera, run); },
          [&] { to.person.PrintUnlikelyStature(to.options, camera); },
          [&] { PrintMissingFloor(to.tracker, to.options); }, [&] { to.trace.Finish(); },
          [&] { to.person.Finish(to.options); }, [&] { CheckComplete(to.options, run); }});
  if (run.full) throw InputError(*run.full);  // of the viewer, since no output failed
}

}  // namespace

int Track(int argc, char** argv) {
  TrackOptions options = ParseTrackOptions(argc, argv);
  options.tracker.models = tracker::ModelSet::Load(options.files, options.tracker.method);
  PrintWarnings("track", options.tracker.models->warnings);
  if (!options.more_sources.empty()) return TrackSeveral(options);
  FindCamera(
      options.source, [&] { return options.tracker; }, options.quiet);
  SetKnownPeople(options);
  tracker::Tracker tracker(options.tracker);  // first: a device must not wait for it
  const auto source = OpenSource(options.source, options.quiet);
  FindUpright(tracker, *source, options.source, options.quiet);
  SkeletonOutput output(options);
  DecisionTrace trace(options.trace);
  Pictures pictures(options);
  PersonKeeper person(options);
  CheckStatsWritable(options);
  const auto viewer = OpenViewer(options);
  stream::Sender sender(options.targets);
  Destinations destinations{options,  tracker, output, trace,
                            pictures, person,  sender, viewer.get()};
  Run run;
  TrackAll(*source, tracker, options, destinations, run);
  CheckWorthKeeping(options, run);
  FinishAll(destinations, source->camera(), run);
  return 0;
}

}  // namespace ossa::commands
