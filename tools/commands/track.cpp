#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <deque>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "depth/base/atomic_file.h"
#include "depth/base/error.h"
#include "depth/sensor/frame_source.h"
#include "recon/files/skeleton_io.h"
#include "recon/files/skeleton_writer.h"
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
#include "tools/commands/view_options.h"
#include "tools/stream/sender.h"
#include "tools/tracker/picture.h"
#include "tools/tracker/run_stats.h"
#include "tools/tracker/shipped.h"
#include "tools/tracker/skeleton_record.h"
#include "tools/viewer/viewer.h"

namespace ossa::commands {
namespace {

using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;

struct TrackOptions {
  SourceArguments source;
  std::string out, json_stats, picture, pictures, trace;
  std::string smoothing, posture = "final", mode = "standing", fit;
  MechanicsOptions mechanics;
  BonesOption bones;
  WriteOptions write;
  tracker::ModelFiles files;
  tracker::TrackerOptions tracker;
  int64_t frames = 0;
  std::vector<std::string> send;
  std::vector<stream::Target> targets;  // of `send`
  PageArguments page;                   // of `view`
  bool view = false;
  bool quiet = false;
};

void AddTrackerOptions(CLI::App& app, TrackOptions& options) {
  tracker::TrackerOptions& t = options.tracker;
  tracker::ModelFiles& files = options.files;
  app.add_option("--model", files.forest, "forest model, .ossa (default: the shipped one)");
  app.add_option("--database", files.database,
                 "posture database, .ossadb (default: the shipped one, of best the shipped prior)");
  app.add_option("--prior", files.prior,
                 ".ossaprior of 'ossa prior', for best (default: the shipped one)");
  app.add_option("--learned", files.learned,
                 ".ossagp of 'ossa learn', for the methods that learn, or none (default: with best "
                 "and the shipped model the shipped one)");
  app.add_option("--refinement,--look", files.refinement,
                 ".ossarefine of 'ossa refine', for best and --posture refined, or none (default: "
                 "with best and the shipped model the shipped one)");
  app.add_option("--surface", files.surface,
                 ".ossasurface of 'ossa surface', for --fit (default: the shipped one)");
  app.add_option("--fit", options.fit,
                 "fit the body's surface to the depth image, from the refined joints on: on or off "
                 "(default: on where there are refined joints)")
      ->check(CLI::IsMember({"on", "off"}));
  app.add_option("--method", t.method, "how postures are completed (default best)")
      ->check(CLI::IsMember(recon::ReconstructionMethods()));
  AddMechanicsOptions(app, options.mechanics);
  options.bones.AddTo(app);
  app.add_option(
         "--smoothing", options.smoothing,
         "preset of the filter (default: what goes with the method, none for those that filter)")
      ->check(CLI::IsMember(tracker::SmoothingPresets()));
  app.add_option("--lag", t.lag,
                 "frames that may come before a frame's bodies are told, smoothed by them: 0 "
                 "(live) to 2 (default 0)")
      ->check(CLI::Range(0, 2));
  app.add_option("--mode", options.mode, "standing (20 joints) or seated (the upper ten)")
      ->check(CLI::IsMember({"standing", "seated"}));
  app.add_flag("--near", t.near_range, "near range: people within 3 m only");
  app.add_option("--users", t.max_users, "most people at a time, 1 to 6 (default 6)")
      ->check(CLI::Range(1, 6));
  app.add_option("--threads", t.threads, "threads for several people (default 1)")
      ->check(CLI::Range(1, 256));
  app.add_option("--seed", t.seed, "of the methods that draw samples (default 1)");
}

// What --posture called them in versions before.
const std::map<std::string, std::string> kOldPostures = {{"looked", "refined"}};

// Refined joints that were asked for are had with every method.
void NeedRefinement(tracker::ModelFiles& files) {
  const bool is_shipped = tracker::IsShippedForest(files);
  if (files.refinement == "none" || (files.refinement.empty() && !is_shipped)) {
    throw UsageError(
        "--posture refined: expected --refinement FILE.ossarefine of 'ossa refine' with it");
  }
  if (files.refinement.empty()) {
    files.refinement = tracker::ShippedFile(recon::kShippedRefinement).string();
  }
}

// A fit that was asked for has a body, and joints to start from.
void CheckFit(const TrackOptions& options) {
  if (options.files.surface == "none") {
    throw UsageError(
        "--fit on: expected --surface FILE.ossasurface of 'ossa surface' with it, found none");
  }
  const std::string& refinement = options.files.refinement;
  const bool is_shipped =
      MethodInfoOf(options.tracker.method).refined && tracker::IsShippedForest(options.files);
  if (refinement == "none" || (refinement.empty() && !is_shipped)) {
    throw UsageError(
        "--fit on: expected --refinement FILE.ossarefine of 'ossa refine' with it, found none");
  }
}

void CheckRefinementIsRead(const TrackOptions& options) {
  const std::string& look = options.files.refinement;
  const bool is_read = MethodInfoOf(options.tracker.method).refined;
  if (look.empty() || look == "none" || is_read || options.quiet) return;
  SayNotRead("--refinement", options.tracker.method);
}

std::vector<stream::Target> TargetsOf(const std::vector<std::string>& urls) {
  std::vector<stream::Target> targets;
  try {
    for (const std::string& url : urls) targets.push_back(stream::ParseTarget(url));
  } catch (const InputError& error) {
    throw UsageError(std::string("track: ") + error.what());
  }
  return targets;
}

TrackOptions ParseOptions(int argc, char** argv) {
  CLI::App app("Follow the people in any SOURCE and write their skeletons");
  TrackOptions options;
  AddSourceOptions(app, options.source);
  AddRotateOption(app, options.source);
  app.add_option("--out", options.out,
                 "skeletons: FILE.jsonl, .bvh, .trc or .csv; .glb: people in motion, skinned");
  app.add_option(
         "--posture", options.posture,
         "what --out gets: final, reconstructed, refined (raw after the refinement cascade) or "
         "raw")
      ->transform(CLI::Transformer(kOldPostures).description(""))
      ->check(CLI::IsMember({"final", "reconstructed", "refined", "raw"}));
  options.write.AddTo(app);
  AddTrackerOptions(app, options);
  app.add_option("--frames", options.frames, "stop after so many frames")->check(Positive());
  AddDeviceOptions(app, options.source);
  app.add_option("--json-stats", options.json_stats,
                 "milliseconds a stage, frames a second, memory, FILE.json ('-': stdout)");
  app.add_option("--trace", options.trace,
                 "FILE.jsonl: a line a frame with every piece of the scene, and the rule that "
                 "decided whether it is a person");
  app.add_option("--picture", options.picture,
                 "FILE.png of one frame: depth, parts, joints, skeleton");
  app.add_option("--pictures", options.pictures, "folder for such a picture of every frame");
  app.add_option("--send", options.send,
                 "live, to vmc://HOST:PORT[?bones=seen] (avatars), vrchat://HOST:PORT[?scale=X] or "
                 "udp://HOST:PORT (JSONL); repeat for more")
      ->allow_extra_args(false);
  app.add_flag("--view", options.view, "show it in browsers while it runs");
  AddPageOptions(app, options.page);
  app.add_flag("--quiet", options.quiet, "no progress");
  Parse(app, argc, argv);
  if (options.out.empty() && options.picture.empty() && options.pictures.empty() && !options.view &&
      options.json_stats.empty() && options.trace.empty() && options.send.empty()) {
    throw UsageError(
        "track: nothing to do: name --out, --picture, --pictures, --json-stats, --trace, --send or "
        "--view");
  }
  options.targets = TargetsOf(options.send);
  CheckRead(app, options.tracker.method, options.quiet);
  CheckLearned(options.tracker.method, options.files.learned);
  options.bones.Check(options.tracker.method);
  options.mechanics.Check();
  CheckOneOf(options.tracker.method, options.files.database, options.files.prior);
  if (options.posture == "refined") {
    NeedRefinement(options.files);
  } else {
    CheckRefinementIsRead(options);
  }
  if (!options.out.empty()) CheckSkeletonName(options.out);
  options.write.Check(options.out);
  CheckExtension("--picture", options.picture, ".png");
  CheckNotOtherKind("--json-stats", options.json_stats, ".json");
  CheckExtension("--trace", options.trace, ".jsonl");
  CheckOutputs({options.out, options.json_stats, options.picture, options.pictures, options.trace},
               {options.source.name});
  options.tracker.turn = TurnOf(options.source);
  if (options.fit == "on") CheckFit(options);
  if (options.fit == "off") options.tracker.fit.reset();
  options.tracker.physics = options.mechanics.on();
  options.tracker.mechanics = options.mechanics.build;
  if (!options.smoothing.empty()) {
    options.tracker.smoothing = tracker::SmoothingPreset(options.smoothing);
  }
  if (options.mode == "seated") options.tracker.mode = tracker::TrackingMode::kSeated;
  options.tracker.trace = !options.trace.empty();
  options.tracker.keep_parts = !options.picture.empty() || !options.pictures.empty();
  return options;
}

// Skeletons on their way to the file, which appears only when complete.
class SkeletonOutput {
 public:
  explicit SkeletonOutput(const TrackOptions& options)
      : path_(options.out), seated_(options.mode == "seated") {
    const std::string& posture = options.posture;
    if (posture == "raw") kind_ = tracker::PostureKind::kRaw;
    if (posture == "refined") kind_ = tracker::PostureKind::kRefined;
    if (posture == "reconstructed") kind_ = tracker::PostureKind::kReconstructed;
    if (path_.empty()) return;
    SayLeftovers(path_);
    writer_.emplace(
        path_,
        options.write.For(path_, options.files.surface == "none" ? "" : options.files.surface));
  }
  void Write(const tracker::BodyFrame& bodies) {
    if (!writer_) return;
    for (const tracker::Body& body : bodies.bodies) {
      if (!body.fit) continue;
      recon::PersonShape& shape = shapes_[body.id];
      shape.Add(*body.fit);
      writer_->SetShape(body.id, shape.shape);
    }
    recon::SkeletonFrame record = tracker::ToRecord(bodies, kind_);
    if (seated_) KeepSeatedJoints(record);
    writer_->Write(record);
  }
  void Finish() {
    try {
      if (writer_) writer_->Finish();
    } catch (const DiskFull& full) {
      throw WithWhatFits(full);
    }
  }
  // Of what Write() threw: how much is kept.
  InputError WithWhatFits(const DiskFull& full) {
    return writer_ ? KeepWhatFits(full, *writer_) : InputError(full);
  }

 private:
  // Nobody looks for the others.
  static void KeepSeatedJoints(recon::SkeletonFrame& record) {
    for (recon::BodyRecord& body : record.bodies) {
      for (size_t j = 0; j < recon::kJointCount; ++j) {
        if (!tracker::IsSeatedJoint(static_cast<recon::Joint>(j))) body.joints[j].reset();
      }
    }
  }

  std::string path_;
  bool seated_ = false;
  tracker::PostureKind kind_ = tracker::PostureKind::kFinal;
  std::optional<recon::SkeletonWriter> writer_;
  std::map<int, recon::PersonShape> shapes_;  // of who was fitted
};

size_t TrackedJoints(const tracker::BodyFrame& bodies) {
  size_t count = 0;
  for (const tracker::Body& body : bodies.bodies) {
    count += static_cast<size_t>(std::count_if(
        body.joints.begin(), body.joints.end(),
        [](const tracker::JointEstimate& j) { return j.state == recon::TrackingState::kTracked; }));
  }
  return count;
}

// The one picture shows the frame in which most is tracked (the latest of equals).
class Pictures {
 public:
  explicit Pictures(const TrackOptions& options)
      : one_(options.picture), folder_(options.pictures) {
    if (!folder_.empty()) std::filesystem::create_directories(folder_);
    if (!one_.empty()) AtomicFile::CheckWritable(one_);
  }
  void Take(const depth::DepthFrame& frame, const tracker::BodyFrame& bodies) {
    if (!folder_.empty()) {
      const auto name = fmt::format("{:06d}.png", bodies.index);
      tracker::WritePicture(std::filesystem::path(folder_) / name, frame, bodies);
    }
    if (one_.empty() || (has_best_ && TrackedJoints(bodies) < TrackedJoints(best_))) return;
    has_best_ = true;
    best_frame_ = frame;
    best_ = bodies;
  }
  void Finish() const {
    if (!one_.empty() && has_best_) tracker::WritePicture(one_, best_frame_, best_);
  }

 private:
  std::string one_, folder_;
  bool has_best_ = false;
  depth::DepthFrame best_frame_;
  tracker::BodyFrame best_;
};

enum class Ending { kComplete, kUnplugged, kSilent, kInterrupted };

struct Run {
  tracker::RunStats stats;
  int64_t dropped = 0;
  std::optional<int64_t> of;  // frames that are to be tracked
  int64_t lost_gaps = 0;      // times the device went away and came back
  Ending ending = Ending::kComplete;
  std::string failure;  // of the source; what was tracked before it stays
};

std::optional<int64_t> FramesWanted(const depth::FrameSource& source, const TrackOptions& options) {
  const std::optional<int64_t> known = source.frame_count();
  if (options.frames == 0) return known;
  return std::min(options.frames, known.value_or(options.frames));
}

/// Where what is tracked goes. Images wait for their bodies, which are late by the lag.
struct Destinations {
  const tracker::Tracker& tracker;
  SkeletonOutput& output;
  DecisionTrace& trace;
  Pictures& pictures;
  stream::Sender& sender;
  viewer::Viewer* viewer = nullptr;
  std::deque<depth::DepthFrame> waiting{};

  void Deliver(const tracker::BodyFrame& bodies, Run& run) {
    run.stats.Add(bodies.ms);
    sender.Send(bodies);  // first: it is waited for
    output.Write(bodies);
    trace.Write(bodies);
    pictures.Take(waiting.front(), bodies);
    if (viewer != nullptr) {
      viewer::Moment moment = viewer::MomentOf(waiting.front(), bodies);
      moment.dropped = run.dropped;
      moment.is_upright = tracker.quarter_turns() == 0;
      moment.latency_ms = bodies.ms.total;
      viewer->Show(std::move(moment));
    }
    waiting.pop_front();
  }
};

void TrackToEnd(depth::FrameSource& source, tracker::Tracker& tracker, const TrackOptions& options,
                Destinations& to, Run& run) {
  Progress progress("tracking", options.quiet);
  const auto known = static_cast<double>(source.frame_count().value_or(0));
  run.of = FramesWanted(source, options);
  auto last_frame_at = Clock::now();
  bool gone = false;
  int64_t tracked = 0;
  while (!Interrupted()) {
    depth::ReadResult read = source.Read(milliseconds(100));
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
    run.dropped += read.dropped;
    const auto bodies = tracker.TrackLate(read.frame);
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

/// Frames that are held when the source ends, or fails, are delivered all the same.
void TrackAll(depth::FrameSource& source, tracker::Tracker& tracker, const TrackOptions& options,
              Destinations& to, Run& run) {
  try {
    TrackToEnd(source, tracker, options, to, run);
  } catch (const DiskFull&) {
    throw;
  } catch (const InputError& error) {
    run.failure = error.what();
  }
  while (const auto held = tracker.TakeHeld()) to.Deliver(*held, run);
}

// How long people's bones are by the whole recording, which is tracked for nothing else.
std::map<int, recon::BoneLengths> MeasureBones(const TrackOptions& options) {
  const auto source = OpenSource(options.source, options.quiet);
  if (source->is_live()) {
    throw UsageError(fmt::format("--bones recording: {}: expected a recording, found a device",
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

void Report(const TrackOptions& options, const Run& run) {
  if (options.json_stats == "-") {
    fmt::print("{}", run.stats.Json(run.dropped));
  } else if (!options.json_stats.empty()) {
    AtomicFile file(options.json_stats);
    file.stream() << run.stats.Json(run.dropped);
    file.Commit();
  }
  if (run.ending == Ending::kUnplugged || run.ending == Ending::kSilent) {
    const char* what = run.ending == Ending::kUnplugged ? "unplugged" : "delivers no frames";
    Say(fmt::format("ossa track: {}: the device {} for {:g} s: ending after {} frames\n",
                    options.source.name, what, options.source.patience_s, run.stats.frames()));
  }
  if (!options.quiet && options.json_stats != "-") {
    fmt::print("{} frames, {} dropped, {} reconnections\n", run.stats.frames(), run.dropped,
               run.lost_gaps);
  }
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

}  // namespace

int Track(int argc, char** argv) {
  TrackOptions options = ParseOptions(argc, argv);
  options.tracker.models = tracker::ModelSet::Load(options.files, options.tracker.method);
  if (options.bones.of_recording()) options.tracker.bones_m = MeasureBones(options);
  tracker::Tracker tracker(options.tracker);  // first: a device's frames do not wait meanwhile
  const auto source = OpenSource(options.source, options.quiet);
  FindUpright(tracker, *source, options.source, options.quiet);
  SkeletonOutput output(options);
  DecisionTrace trace(options.trace);
  Pictures pictures(options);
  if (!options.json_stats.empty() && options.json_stats != "-")
    AtomicFile::CheckWritable(options.json_stats);
  std::unique_ptr<viewer::Viewer> viewer;
  if (options.view) {
    viewer::ViewerOptions page = PageOptions(options.page);
    page.name = options.source.name;
    page.forest = options.tracker.models->forest;
    viewer = std::make_unique<viewer::Viewer>(page);
    SayWhere(*viewer);
  }
  stream::Sender sender(options.targets);
  Destinations destinations{tracker, output, trace, pictures, sender, viewer.get()};
  Run run;
  try {
    TrackAll(*source, tracker, options, destinations, run);
  } catch (const DiskFull& full) {
    throw output.WithWhatFits(full);
  }
  if (!run.failure.empty() && (run.stats.frames() == 0 || options.out.empty())) {
    throw InputError(run.failure);
  }
  CheckFrames(options, run);
  output.Finish();
  pictures.Finish();
  Report(options, run);
  trace.Finish();
  if (!run.failure.empty()) {
    throw InputError(fmt::format("{}; the {} before it are in {}", run.failure,
                                 FramesText(run.stats.frames(), run.of), options.out));
  }
  if (run.ending == Ending::kInterrupted) throw InterruptedEarly(options, run);
  return 0;
}

}  // namespace ossa::commands
