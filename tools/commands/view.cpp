#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "depth/base/atomic_file.h"
#include "depth/base/error.h"
#include "depth/base/one_line.h"
#include "depth/sensor/frame_source.h"
#include "recon/files/skeleton_io.h"
#include "recon/methods/reconstructor.h"
#include "tools/commands/command.h"
#include "tools/commands/commands.h"
#include "tools/commands/fit_options.h"
#include "tools/commands/mechanics_options.h"
#include "tools/commands/method_options.h"
#include "tools/commands/model_options.h"
#include "tools/commands/parse_consistently.h"
#include "tools/commands/process.h"
#include "tools/commands/reading_bar.h"
#include "tools/commands/source_options.h"
#include "tools/commands/view_options.h"
#include "tools/commands/warnings.h"
#include "tools/tracker/smoothing.h"
#include "tools/tracker/tracker.h"
#include "tools/viewer/playback_clock.h"
#include "tools/viewer/viewer.h"

namespace ossa::commands {
namespace {

using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;

struct ViewOptions {
  SourceArguments source;
  tracker::ModelFiles files;
  tracker::TrackerOptions tracker;
  PageArguments page;
  MechanicsOptions mechanics;
  viewer::Settings settings;
  std::vector<std::string> over;
  std::string mesh, mount = "auto";
  FitArguments fit;
  std::string record_to;
  bool once = false;
};

void ShowLastFrame() { std::this_thread::sleep_for(viewer::PlaybackClock::LastFramesTime()); }

bool IsSource(const std::string& what) {
  return IsDevice(what) || std::filesystem::is_directory(what) || depth::IsRecording(what);
}

// Those that work with the files that were given.
std::vector<std::string> MethodsToChoose(const tracker::ModelFiles& files) {
  std::vector<std::string> methods = recon::ReconstructionMethods();
  std::erase_if(methods, [&](const std::string& method) {
    return RequireMethodInfo(method).learned == recon::Reads::kRequired && files.learned.empty();
  });
  return methods;
}

recon::SkeletonSequence Read(const std::string& path, double fps) {
  recon::SkeletonReadOptions reading;
  if (fps > 0) reading.frame_s = 1.0 / fps;
  reading.progress = ReadingBar(false);
  recon::SkeletonSequence sequence = recon::ReadSkeletons(path, reading);
  PrintWarnings("view", sequence.warnings);
  return sequence;
}

viewer::ViewerOptions MakeViewerOptions(const ViewOptions& options) {
  viewer::ViewerOptions with = PageOptions(options.page);
  with.name = std::filesystem::path(options.source.name).filename().string();
  // The driver's options in a camera's URI are not part of its name.
  if (IsDevice(options.source.name)) with.name = with.name.substr(0, with.name.find('?'));
  if (with.name.empty()) with.name = options.source.name;
  if (with.name == "-") with.name = "standard input";
  with.body = LoadSkin(options.files.surface, options.mesh);
  for (const std::string& path : options.over) {
    recon::SkeletonSequence sequence = Read(path, options.source.fps);
    with.overlays.push_back({std::filesystem::path(path).filename().string(), sequence});
  }
  return with;
}

tracker::TrackerOptions MakeOptions(const ViewOptions& options, const viewer::Settings& settings) {
  tracker::TrackerOptions with = options.tracker;
  with.method = settings.method;
  with.models = tracker::ModelSet::Load(options.files, with.method);
  with.shapes = ReadPeople(options.fit, *with.models);
  if (!settings.smoothing.empty()) with.smoothing = tracker::SmoothingPreset(settings.smoothing);
  with.mode = settings.seated ? tracker::TrackingMode::kSeated : tracker::TrackingMode::kStanding;
  with.near_range = settings.near_range;
  with.max_users = settings.users;
  with.physics = options.mechanics.on();
  with.mechanics = options.mechanics.build;
  with.scene = options.mechanics.Scene();
  return with;
}

tracker::Tracker MakeTracker(const ViewOptions& options, const viewer::Settings& settings,
                             bool is_live) {
  tracker::TrackerOptions with = MakeOptions(options, settings);
  PrintWarnings("view", with.models->warnings);
  with.keep_parts = !is_live;  // of a camera the page finds them, for who looks
  return tracker::Tracker(with);
}

void WaitUntilInterrupted() {
  while (!Interrupted()) std::this_thread::sleep_for(milliseconds(100));
}

void ShowSkeletons(const ViewOptions& options) {
  const recon::SkeletonSequence sequence = Read(options.source.name, options.source.fps);
  viewer::ViewerOptions with = MakeViewerOptions(options);
  with.keeps = true;
  with.expected_frames = static_cast<int64_t>(sequence.frames.size());
  viewer::Viewer viewer(with);
  PrintUrls(viewer);
  viewer::PlaybackClock clock;
  for (const recon::SkeletonFrame& frame : sequence.frames) {
    if (Interrupted()) return;
    if (options.once) std::this_thread::sleep_until(clock.DueAt(frame.time_s));
    viewer.Show(viewer::MakeDisplayFrame(frame));
  }
  viewer.Complete();
  if (options.once) return ShowLastFrame();
  WaitUntilInterrupted();
}

// The tracker behind a page: sends its frames to the page and applies the page's settings.
class PageTracker {
 public:
  explicit PageTracker(const ViewOptions& options)
      : options_(options),
        source_(OpenSource(options.source, false)),
        settings_(options.settings),
        tracker_(MakeTracker(options, settings_, source_->is_live())) {
    FindUpright(tracker_, *source_, options_.source, false);
    viewer::ViewerOptions with = MakeViewerOptions(options);
    with.keeps = !source_->is_live();
    with.expected_frames = source_->frame_count();
    with.settings = settings_;
    with.methods = MethodsToChoose(options.files);
    with.smoothings = tracker::SmoothingPresets();
    if (source_->is_live()) {
      with.recordings = options.record_to;
      with.forest = tracker::ModelSet::Load(options.files, settings_.method).forest;
    }
    viewer_ = std::make_unique<viewer::Viewer>(with);
    PrintUrls(*viewer_);
  }

  void Run() {
    while (!Interrupted()) {
      if (ApplySettings() && !source_->is_live()) Rewind();
      const depth::ReadResult read = source_->Read(milliseconds(100));
      if (read.status == depth::ReadStatus::kFrame) Show(read);
      PrintUnplugged(read.status);
      if (read.status != depth::ReadStatus::kEnd) continue;
      progress_.reset();
      viewer_->Complete();
      if (options_.once) return ShowLastFrame();
      WaitForSettings();
    }
  }

 private:
  // Once each time that a camera goes: the page just stands still.
  void PrintUnplugged(depth::ReadStatus status) {
    const bool is_gone = status == depth::ReadStatus::kDisconnected;
    if (is_gone && !gone_) {
      PrintError(
          fmt::format("ossa view: {}: the device is unplugged: waiting for it (Ctrl-C ends it)\n",
                      OnOneLine(options_.source.name)));
    }
    gone_ = is_gone || (gone_ && status != depth::ReadStatus::kFrame);
  }

  void Show(const depth::ReadResult& read) {
    const Clock::time_point arrived = Clock::now();
    dropped_ += read.dropped;
    if (options_.once && !source_->is_live()) {
      std::this_thread::sleep_until(clock_.DueAt(read.frame.time_s));
    }
    tracker::BodyFrame bodies = tracker_.Track(read.frame);
    PrintWarning("view", options_.source.name, tracker_);
    std::vector<viewer::Solid> solids = viewer::SolidsOf(bodies, options_.mechanics.follows());
    viewer::DisplayFrame display = viewer::MakeDisplayFrame(read.frame, std::move(bodies));
    display.solids = std::move(solids);
    display.dropped = dropped_;
    display.is_upright = tracker_.quarter_turns() == 0;
    display.latency_ms = std::chrono::duration<double, std::milli>(Clock::now() - arrived).count();
    viewer_->Show(std::move(display));
    ShowProgress();
  }

  // Through a recording that is tracked as fast as it goes, for who watches the terminal.
  void ShowProgress() {
    const auto frames = source_->frame_count();
    if (!frames || options_.once || !CanMoveCursor()) return;
    if (!progress_) progress_.emplace("tracking", false);
    progress_->Update(static_cast<double>(++shown_), static_cast<double>(*frames));
  }

  bool ApplySettings() {
    const std::optional<viewer::Settings> asked =
        next_settings_ ? std::exchange(next_settings_, {}) : viewer_->TakeSettings();
    if (!asked) return false;
    try {
      tracker_ = MakeTracker(options_, *asked, source_->is_live());
      settings_ = *asked;
      return true;
    } catch (const InputError& error) {
      viewer_->Refuse(settings_, error.what());
      return false;
    }
  }

  void WaitForSettings() {
    while (!Interrupted() && !next_settings_) {
      std::this_thread::sleep_for(milliseconds(100));
      next_settings_ = viewer_->TakeSettings();
    }
  }

  void Rewind() {
    source_ = OpenSource(options_.source, true);
    FindUpright(tracker_, *source_, options_.source, true);
    viewer_->Clear();
    progress_.reset();
    shown_ = dropped_ = 0;
  }

  const ViewOptions& options_;
  std::unique_ptr<depth::FrameSource> source_;
  viewer::Settings settings_;
  std::optional<viewer::Settings> next_settings_;
  tracker::Tracker tracker_;
  std::unique_ptr<viewer::Viewer> viewer_;
  viewer::PlaybackClock clock_;
  std::optional<Progress> progress_;
  int64_t shown_ = 0, dropped_ = 0;  // frames
  bool gone_ = false;                // the camera is unplugged
};

void AddTrackingOptions(CLI::App& app, ViewOptions& options) {
  AddModelOptions(app, options.files);
  app.add_option("--method", options.settings.method, "method of reconstruction (default best)")
      ->check(CLI::IsMember(recon::ReconstructionMethods()));
  app.add_option("--smoothing", options.settings.smoothing,
                 "preset of the joint filter (default: depends on the method)")
      ->check(CLI::IsMember(tracker::SmoothingPresets()));
  app.add_option("--surface", options.files.surface,
                 ".ossasurface of 'ossa surface', the body that is fitted, or none: no fit, which "
                 "is faster (default: the shipped one)");
  app.add_option("--mesh", options.mesh,
                 ".ossamesh of 'ossa surface', the skin of that body, on the page and in a .glb "
                 "that it exports, or none (default: the shipped one)");
  AddFitOptions(app, options.fit);
  AddMechanicsOptions(app, options.mechanics);
  AddMountOption(app, options.mount);
  app.add_flag("--seated", options.settings.seated, "look for the ten upper joints only");
  app.add_flag("--near", options.settings.near_range,
               "near range: people within 3 m of a level camera only");
  app.add_option("--users", options.settings.users, "maximum number of people, 1 to 6 (default 6)")
      ->check(CLI::Range(1, 6));
}

// Skeletons of a file are shown as they are.
void PrintTrackingOptions(const CLI::App& app, const std::string& file) {
  for (const char* option :
       {"--model",        "--database",     "--prior",     "--learned",      "--refinement",
        "--pose-network", "--method",       "--smoothing", "--physics",      "--scene",
        "--mount",        "--seated",       "--near",      "--users",        "--fit",
        "--person",       "--control",      "--hinges",    "--joint-limits", "--camera",
        "--depth-scale",  "--depth-format", "--mirrored",  "--rotate",       "--record-to"}) {
    if (app.count(option) == 0) continue;
    PrintError(fmt::format(
        "ossa view: {}: {} is for a source that is tracked: these are skeletons\n", file, option));
  }
}

void DeclareOptions(CLI::App& app, ViewOptions& options) {
  options.settings.method = recon::kDefaultMethod;
  AddSourceOptions(app, options.source);
  AddPageOptions(app, options.page);
  AddTrackingOptions(app, options);
  app.add_option("--over", options.over,
                 "skeletons to overlay, with their distance to those shown; repeat for more")
      ->allow_extra_args(false);
  app.add_option(
      "--record-to", options.record_to,
      "folder for recordings made with the page's record button (default: the current one)");
  app.add_flag("--once", options.once, "play a recording once at its own speed, and end with it");
}

void CheckOptions(const CLI::App& app, ViewOptions& options) {
  CheckDepthScale(options.source);
  CheckRead(app, options.settings.method);
  CheckLearned(options.settings.method, options.files.learned);
  const FitNeeds needs{options.files, options.settings.method, options.mount,
                       options.settings.users};
  if (options.fit.fit == "on") CheckFit(options.fit, needs);
  CheckPeople(options.fit, "", needs);
  options.mechanics.Check();
  if (!options.record_to.empty()) {
    AtomicFile::CheckWritable(std::filesystem::path(options.record_to) / "recording");
  }
}

void PrintNotes(const CLI::App& app, const ViewOptions& options) {
  PrintFilesNotRead(app, options.settings.method);
  if (!IsSource(options.source.name)) PrintTrackingOptions(app, options.source.name);
}

}  // namespace

int View(int argc, char** argv) {
  auto options = ParseConsistently<ViewOptions>(
      {"Show a SOURCE being tracked, or a skeleton file given as SOURCE, in browsers: depth, parts "
       "and skeletons in 3D, a recording with its time line",
       DeclareOptions, CheckOptions, PrintNotes},
      argc, argv);
  options.tracker.turn = ChooseTurn(options.source);
  options.tracker.mount = ParseMount(options.mount);
  if (options.fit.is_off()) options.tracker.fit.reset();
  if (IsSource(options.source.name)) {
    FindCamera(
        options.source, [&] { return MakeOptions(options, options.settings); }, false);
    PageTracker(options).Run();
  } else {
    ShowSkeletons(options);
  }
  return 0;
}

}  // namespace ossa::commands
