#include "tools/commands/track_options.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <map>

#include "depth/base/error.h"
#include "recon/methods/reconstructor.h"
#include "recon/refine/refinement_cascade.h"
#include "tools/commands/command.h"
#include "tools/commands/model_options.h"
#include "tools/commands/parse_consistently.h"
#include "tools/commands/process.h"
#include "tools/tracker/shipped.h"

namespace ossa::commands {
namespace {

void AddBodyOptions(CLI::App& app, TrackOptions& options) {
  app.add_option("--surface", options.files.surface,
                 ".ossasurface of 'ossa surface', for --fit (default: the shipped one)");
  AddFitOptions(app, options.fit);
  app.add_option("--save-person", options.save_person,
                 "write FILE.ossaperson at the end: body shape of the person who was fitted in "
                 "most frames, updated from --person");
}

void AddPostureOptions(CLI::App& app, TrackOptions& options) {
  app.add_option("--method", options.tracker.method, "method of reconstruction (default best)")
      ->check(CLI::IsMember(recon::ReconstructionMethods()));
  AddMechanicsOptions(app, options.mechanics);
  options.bones.AddTo(app);
  app.add_option(
         "--smoothing", options.smoothing,
         "preset of the joint filter (default: depends on the method; none for those that filter)")
      ->check(CLI::IsMember(tracker::SmoothingPresets()));
  app.add_option(
         "--lag", options.lag,
         "frames of delay, used to smooth: 0 to 2 (default: 2 for recordings with best, else 0)")
      ->check(CLI::Range(0, 2));
}

void AddViewpointOptions(CLI::App& app, TrackOptions& options) {
  tracker::TrackerOptions& t = options.tracker;
  app.add_option("--mode", options.mode, "standing (20 joints) or seated (the upper ten)")
      ->check(CLI::IsMember({"standing", "seated"}));
  AddMountOption(app, options.mount);
  app.add_flag("--near", t.near_range, "near range: people within 3 m of a level camera only");
  app.add_option("--users", t.max_users, "maximum number of people, 1 to 6 (default 6)")
      ->check(CLI::Range(1, 6));
  app.add_option("--threads", t.threads, "threads for several people (default 1)")
      ->check(CLI::Range(1, 256));
  app.add_option("--seed", t.seed, "random seed of the methods that draw samples (default 1)");
}

// What --posture called them in versions before.
const std::map<std::string, std::string> kOldPostures = {{"looked", "refined"}};

// Refined joints that were asked for are had with every method.
void RequireRefinement(tracker::ModelFiles& files) {
  const char* const shipped = tracker::FindShippedRefinement(files);
  if (files.refinement == "none" || (files.refinement.empty() && shipped == nullptr)) {
    throw Contradiction(
        "--posture refined: expected --refinement FILE.ossarefine of 'ossa refine' with it");
  }
  if (files.refinement.empty()) files.refinement = tracker::ShippedFile(shipped).string();
}

void PrintUnreadRefinement(const TrackOptions& options) {
  const std::string& look = options.files.refinement;
  const bool is_read = RequireMethodInfo(options.tracker.method).refined;
  if (look.empty() || look == "none" || is_read || options.quiet) return;
  PrintNotRead("--refinement", options.tracker.method);
}

// Recordings can wait: with lag, bodies are more accurate and steadier.
int DefaultLag(const TrackOptions& options) {
  constexpr int kMost = 2;  // frames; measured: docs/benchmarks/reconstruction.md, frames of lag
  const bool smoothed = RequireMethodInfo(options.tracker.method).smoothed_in_files;
  return smoothed && !IsLive(options.source.name) ? kMost : 0;
}

// What belongs to one camera goes with one source, what joins cameras with several.
void CheckSources(const CLI::App& app, const TrackOptions& options) {
  const bool several = !options.more_sources.empty();
  const std::vector<const char*> of_several = {"--extrinsics", "--save-extrinsics", "--max-offset"};
  const std::vector<const char*> of_one = {"--picture",     "--pictures",  "--trace",  "--send",
                                           "--view",        "--scene",     "--person", "--bones",
                                           "--save-person", "--json-stats"};
  for (const char* option : several ? of_one : of_several) {
    if (app.count(option) == 0) continue;
    throw Contradiction(
        fmt::format("{}: expected {} with it", option, several ? "one source" : "several sources"));
  }
  if (!several) return;
  for (const std::string& name : options.Sources()) {
    if (!IsLive(name)) continue;
    throw UsageError(
        fmt::format("track: {}: expected recordings where there are several sources, found a "
                    "device or a pipe: record each with 'ossa record' first",
                    name));
  }
  options.fuse.Check(options.Sources());
}

std::vector<stream::Target> ParseTargets(const std::vector<std::string>& urls) {
  std::vector<stream::Target> targets;
  try {
    for (const std::string& url : urls) targets.push_back(stream::ParseTarget(url));
  } catch (const InputError& error) {
    throw UsageError(std::string("track: ") + error.what());
  }
  return targets;
}

void AddTrackerOptions(CLI::App& app, TrackOptions& options) {
  AddModelOptions(app, options.files);
  AddBodyOptions(app, options);
  AddPostureOptions(app, options);
  AddViewpointOptions(app, options);
}

void AddSkeletonOptions(CLI::App& app, TrackOptions& options) {
  app.add_option("--out", options.out,
                 "skeletons: FILE.jsonl, .bvh, .trc or .csv; .glb: people in motion, skinned");
  app.add_option(
         "--posture", options.posture,
         "joints to write: final (default), reconstructed, fitted (of the body fitted to the depth "
         "image, with standard deviations), refined (after the refinement cascade) or raw")
      ->transform(CLI::Transformer(kOldPostures).description(""))
      ->check(CLI::IsMember({"final", "reconstructed", "fitted", "refined", "raw"}));
  options.write.AddTo(app);
}

void AddOtherOutputs(CLI::App& app, TrackOptions& options) {
  app.add_option(
      "--json-stats", options.json_stats,
      "write milliseconds per stage, frames per second and memory to FILE.json ('-': stdout)");
  app.add_option("--trace", options.trace,
                 "FILE.jsonl: a line per frame with every region of the scene, and the rule that "
                 "decided whether it is a person");
  app.add_option("--picture", options.picture,
                 "FILE.png of one frame: depth, parts, joints, skeleton");
  app.add_option("--pictures", options.pictures, "folder for such a picture of every frame");
  app.add_option("--send", options.send,
                 "live, to vmc://HOST:PORT[?bones=seen] (avatars), vrchat://HOST:PORT[?scale=X] or "
                 "udp://HOST:PORT (JSONL); repeat for more")
      ->allow_extra_args(false);
  app.add_flag("--view", options.view,
               "serve a live view for browsers, fitted bodies in the skin of --mesh");
  AddPageOptions(app, options.page);
  app.add_flag("--quiet", options.quiet, "no progress");
}

void DeclareOptions(CLI::App& app, TrackOptions& options) {
  AddSourceOptions(app, options.source);
  app.add_option("MORE", options.more_sources,
                 "further recordings of the same people at the same time by other cameras: fused, "
                 "in the first one's camera space and at its times");
  options.fuse.AddTo(app);
  AddSkeletonOptions(app, options);
  AddTrackerOptions(app, options);
  app.add_option("--frames", options.frames, "stop after this number of frames")->check(Positive());
  AddDeviceOptions(app, options.source);
  AddOtherOutputs(app, options);
}

void CheckHasOutput(const TrackOptions& options) {
  const bool has_file = !options.out.empty() || !options.fuse.save_extrinsics.empty() ||
                        !options.picture.empty() || !options.pictures.empty() ||
                        !options.json_stats.empty() || !options.trace.empty() ||
                        !options.save_person.empty();
  if (has_file || options.view || !options.send.empty()) return;
  throw UsageError(
      "track: nothing to do: name --out, --picture, --pictures, --json-stats, --trace, --send, "
      "--save-person or --view");
}

// No refusal: a file of defaults may have them for the runs that show a page.
void PrintUnreadPageOptions(const CLI::App& app, const TrackOptions& options) {
  if (options.view || options.quiet) return;
  for (const char* option : {"--port", "--listen", "--token"}) {
    if (app.count(option) > 0)
      PrintError(fmt::format("ossa: {} is not read without --view\n", option));
  }
}

void CheckMethod(const CLI::App& app, const TrackOptions& options) {
  const std::string& method = options.tracker.method;
  CheckRead(app, method);
  CheckLearned(method, options.files.learned);
  options.bones.Check(method);
  options.mechanics.Check();
  CheckOneOf(method, options.files.database, options.files.prior);
}

FitNeeds GetFitNeeds(const TrackOptions& options) {
  return {options.files, options.tracker.method, options.mount, options.tracker.max_users};
}

void CheckFiles(const TrackOptions& options) {
  if (!options.out.empty()) CheckSkeletonName(options.out);
  options.write.Check(options.out);
  CheckExtension("--picture", options.picture, ".png");
  CheckNotOtherKind("--json-stats", options.json_stats, ".json");
  CheckExtension("--trace", options.trace, ".jsonl");
  CheckNotOtherKind("--save-person", options.save_person, ".ossaperson");
  CheckPeople(options.fit, options.save_person, GetFitNeeds(options));
  // A person file may be written over what was read of the same person.
  std::vector<std::string> inputs = options.Sources();
  inputs.push_back(options.mechanics.scene);
  inputs.push_back(options.fuse.File());
  CheckOutputs({options.out, options.json_stats, options.picture, options.pictures, options.trace,
                options.save_person, options.fuse.save_extrinsics},
               inputs);
}

void CheckOptions(const CLI::App& app, TrackOptions& options) {
  CheckSources(app, options);
  CheckDepthScale(options.source);
  CheckHasOutput(options);
  options.targets = ParseTargets(options.send);
  CheckMethod(app, options);
  if (options.posture == "refined") RequireRefinement(options.files);
  if (options.files.surface != "none") options.write.surface = options.files.surface;
  options.write.has_page = options.view;
  CheckFiles(options);
  if (options.fit.fit == "on" || options.posture == "fitted") {
    CheckFit(options.fit, GetFitNeeds(options));
  }
}

void PrintNotes(const CLI::App& app, const TrackOptions& options) {
  PrintUnreadPageOptions(app, options);
  PrintUnreadDeviceOptions(app, options.source, options.quiet);
  if (!options.quiet) PrintFilesNotRead(app, options.tracker.method);
  if (options.posture != "refined") PrintUnreadRefinement(options);
}

// Converts the command's options to the tracker's.
tracker::TrackerOptions MakeTrackerOptions(const TrackOptions& options) {
  tracker::TrackerOptions made = options.tracker;
  made.turn = ChooseTurn(options.source);
  made.lag = options.lag.value_or(DefaultLag(options));
  if (options.fit.is_off()) made.fit.reset();
  made.physics = options.mechanics.on();
  made.mechanics = options.mechanics.build;
  made.scene = options.mechanics.Scene();
  if (!options.smoothing.empty()) made.smoothing = tracker::SmoothingPreset(options.smoothing);
  made.mount = ParseMount(options.mount);
  if (options.mode == "seated") made.mode = tracker::TrackingMode::kSeated;
  made.trace = !options.trace.empty();
  made.keep_parts = !options.picture.empty() || !options.pictures.empty();
  return made;
}

}  // namespace

TrackOptions ParseTrackOptions(int argc, char** argv) {
  auto options =
      ParseConsistently<TrackOptions>({"Track the people in any SOURCE and write their skeletons",
                                       DeclareOptions, CheckOptions, PrintNotes},
                                      argc, argv);
  options.tracker = MakeTrackerOptions(options);
  return options;
}

}  // namespace ossa::commands
