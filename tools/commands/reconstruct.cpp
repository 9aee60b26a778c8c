#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <tuple>
#include <vector>

#include "depth/base/atomic_file.h"
#include "depth/base/error.h"
#include "recon/database/posture_database.h"
#include "recon/files/skeleton_io.h"
#include "recon/filters/butterworth.h"
#include "recon/filters/lag_smoothing.h"
#include "recon/methods/reconstruct_sequence.h"
#include "tools/commands/checks.h"
#include "tools/commands/command.h"
#include "tools/commands/commands.h"
#include "tools/commands/floor_option.h"
#include "tools/commands/mapping_option.h"
#include "tools/commands/mechanics_options.h"
#include "tools/commands/method_options.h"
#include "tools/commands/outputs.h"
#include "tools/commands/process.h"
#include "tools/commands/reading_bar.h"
#include "tools/commands/warnings.h"
#include "tools/tracker/dynamics.h"
#include "tools/tracker/mechanics.h"
#include "tools/tracker/model_set.h"
#include "tools/tracker/scene.h"
#include "tools/tracker/shipped.h"

namespace ossa::commands {
namespace {

struct ReconstructArguments {
  std::string skeletons, out;
  tracker::ModelFiles files;  // those without images
  recon::ReconstructorOptions options;
  recon::SkeletonReadOptions read;
  MechanicsOptions mechanics;
  FloorOption floor;
  std::string dynamics;  // file of inverse dynamics
  double mass_kg = 0.0;
  BonesOption bones;
  WriteOptions write;
  std::vector<double> weights;
  double cutoff_hz = 6.0;
  std::string lag;  // as --lag says, "" what goes with the method
  bool quiet = false;
  bool no_reliability = false;
};

/// What is learned of the recordings' sensor: the file that was named; else, for methods that take
/// a correction, the shipped one of the sensor that all recordings are of.
std::string LearnedFor(const ReconstructArguments& a,
                       const std::vector<recon::SkeletonClip>& clips) {
  if (a.files.learned == "none" || !ReadsLearned(a.options.method)) return {};
  const bool is_correction = RequireMethodInfo(a.options.method).learned == recon::Reads::kOptional;
  if (!a.files.learned.empty() || !is_correction) return a.files.learned;
  const std::string sensor = clips.empty() ? "" : clips.front().sequence.sensor;
  const tracker::KnownSensor* known = tracker::FindKnownSensor(sensor);
  const bool all = std::all_of(clips.begin(), clips.end(), [&sensor](const auto& clip) {
    return clip.sequence.sensor == sensor;
  });
  if (known == nullptr || !all) return {};
  if (!a.quiet) {
    Say(
        fmt::format("reconstruct: {}: their known errors are taken off ({}; --learned none "
                    "leaves them)\n",
                    known->description, known->correction));
  }
  return tracker::ShippedFile(known->correction).string();
}

/// Whether --out is a folder: of several recordings, and of one that is in a folder or archive
/// where --out has no extension. Throws UsageError for several and a name that ends as one file's.
bool GoesToFolder(const ReconstructArguments& a, const std::vector<recon::SkeletonClip>& clips) {
  const std::filesystem::path out(a.out);
  if (clips.size() == 1) return out.extension().empty() && !clips[0].name.empty();
  for (const char* one : {".jsonl", ".bvh", ".glb", ".trc", ".csv"}) {
    if (out.extension() != one) continue;
    throw UsageError(fmt::format("{}: expected a folder for {} recordings, as {} and {}", a.out,
                                 clips.size(), clips[0].name, clips[1].name));
  }
  return true;
}

void AddMethodOptions(CLI::App& app, ReconstructArguments& a) {
  auto methods = recon::ReconstructionMethods();
  methods.emplace_back(kButterworth);
  app.add_option("--method", a.options.method, "how the postures are made whole")
      ->capture_default_str()
      ->check(CLI::IsMember(methods));
  app.add_option("--database", a.files.database,
                 "posture database; without it the shipped one, of best the shipped prior");
  app.add_option("--prior", a.files.prior, ".ossaprior of 'ossa prior', for best");
  app.add_option(
      "--learned", a.files.learned,
      "what `ossa learn` wrote, .ossagp, or none; without it best takes off what is "
      "known of the errors of a Kinect v2 or the refinement cascade where the recording is theirs");
  app.add_option("--seed", a.options.seed, "of the stochastic search")->capture_default_str();
  app.add_option("--cutoff", a.cutoff_hz, "of butterworth, Hz")
      ->capture_default_str()
      ->check(Positive());
  recon::LocalPcaOptions& pca = a.options.local_pca;
  app.add_option("--solver", pca.solver, "of shum-2013, plantard-2016: stochastic or ceres")
      ->capture_default_str()
      ->check(CLI::IsMember({"stochastic", "ceres"}));
  app.add_option("--neighbours", pca.neighbours, "K of the local PCA of shum-2013, plantard-2016")
      ->capture_default_str()
      ->check(CLI::Range(2, 100000));
  const std::tuple<const char*, int*, const char*> counts[] = {
      {"--dimensions", &pca.dimensions, "of that PCA"},
      {"--steps", &pca.steps, "of the search in its space"},
      {"--samples", &pca.samples, "a step of the stochastic search"}};
  for (const auto& [name, value, meaning] : counts) {
    app.add_option(name, *value, meaning)->capture_default_str()->check(CLI::Range(1, 100000));
  }
  app.add_option("--weights", a.weights,
                 "control, style, kinematics, continuity (Shum 2013 eq. 15)")
      ->expected(4)
      ->delimiter(',');
  app.add_flag("--no-reliability", a.no_reliability, "method B of Shum 2013");
  app.add_flag("--keep-reliable", pca.keep_reliable,
               "shum-2013, plantard-2016: joints stay where they were seen, as far as that is "
               "reliable (not in the papers)");
  app.add_flag("--extend", pca.extend_database,
               "of shum-2013: reliable postures join the database (sec. IX)");
  a.bones.AddTo(app);
  app.add_option("--lag", a.lag,
                 "frames after each that smooth it: 0 to 2, or whole, as many before and after as "
                 "help (default: whole with best, else 0)")
      ->check(CLI::IsMember({"0", "1", "2", "whole"}));
}

/// How the result is smoothed: bones that have constant lengths keep them.
recon::LagOptions LagFor(const ReconstructArguments& a) {
  const std::string usual = RequireMethodInfo(a.options.method).smoothed_in_files ? "whole" : "0";
  const std::string& lag = a.lag.empty() ? usual : a.lag;
  return recon::LagOptions::Of(lag == "whole" ? recon::kWholeRecording : std::stoi(lag),
                               KeepsBones(a.options.method));
}

void AddDynamicsOptions(CLI::App& app, ReconstructArguments& a) {
  a.floor.AddTo(app);
  app.add_option("--dynamics", a.dynamics,
                 "inverse dynamics of the character as CSV: torques of joints, forces of the "
                 "ground, centre of pressure (needs --physics on and a floor)");
  app.add_option("--mass", a.mass_kg, "of the person, kg, for --dynamics; by the bones if left out")
      ->check(CLI::Range(3.0, 400.0));
}

void CheckDynamics(const ReconstructArguments& a) {
  if (a.dynamics.empty() && a.mass_kg > 0.0)
    throw UsageError("--mass: expected --dynamics with it");
  if (!a.dynamics.empty() && (!a.mechanics.on() || !a.mechanics.scene.empty())) {
    throw UsageError("--dynamics: expected --physics on with it, and no --scene");
  }
}

/// Before hours of work: one file holds one recording.
void CheckDynamicsOf(const ReconstructArguments& a, size_t recordings) {
  if (a.dynamics.empty()) return;
  if (recordings > 1) {
    throw UsageError(fmt::format("--dynamics: expected one recording, found {}", recordings));
  }
  AtomicFile::CheckWritable(a.dynamics);
}

/// All people of a recording in one world. `update`: as FollowMechanically's progress.
void PlayScene(const tracker::SceneOptions& options, recon::SkeletonSequence& sequence,
               const ReconstructArguments& a, const std::function<bool(size_t)>& update) {
  tracker::Scene scene(options);
  size_t done = 0;
  for (recon::SkeletonFrame& frame : sequence.frames) {
    scene.Play(frame);
    if (!update(++done)) return;
  }
  if (scene.has_floor() || options.objects.empty()) return;
  Say(
      fmt::format("ossa reconstruct: {}: the recording has no floor, so that no object appeared: "
                  "expected floor = [a, b, c, d] in the file, or --floor\n",
                  a.mechanics.scene));
}

InputError InterruptedEarly(const ReconstructArguments& a, size_t written, double total) {
  if (written == 0) return InputError("reconstruct: interrupted; nothing was written");
  return InputError(
      fmt::format("{}: interrupted: {} are in {}", a.skeletons,
                  FramesText(static_cast<int64_t>(written), static_cast<int64_t>(total)), a.out));
}

}  // namespace

int Reconstruct(int argc, char** argv) {
  CLI::App app("Make recorded skeletons complete and plausible");
  ReconstructArguments a;
  app.add_option("SKELETONS", a.skeletons, "skeleton JSONL or a recording of an SDK")->required();
  app.add_option("--out", a.out,
                 "result: .jsonl .bvh .glb .trc .csv, or a folder for many recordings")
      ->required();
  a.write.AddTo(app);
  AddMethodOptions(app, a);
  AddMechanicsOptions(app, a.mechanics);
  AddDynamicsOptions(app, a);
  AddMappingOption(app, a.read.mapping_file, false);
  app.add_flag("--quiet", a.quiet, "no progress");
  app.footer(
      std::string("Options that the method does not read are refused; of files it is said.\n") +
      MappingHelp());
  Parse(app, argc, argv);
  recon::LocalPcaOptions& pca = a.options.local_pca;
  pca.use_reliability = !a.no_reliability;
  double* const weights[] = {&pca.control, &pca.style, &pca.kinematics, &pca.continuity};
  for (size_t i = 0; i < a.weights.size(); ++i) *weights[i] = a.weights[i];

  CheckRead(app, a.options.method, a.quiet);
  if (a.options.local_pca.solver == "ceres" && app.count("--samples") > 0) {
    throw UsageError("--samples is not read by --solver ceres: expected --solver stochastic");
  }
  CheckLearned(a.options.method, a.files.learned);
  a.bones.Check(a.options.method);
  a.write.Check(a.out);
  a.mechanics.Check();
  a.floor.Check();
  CheckDynamics(a);
  CheckOneOf(a.options.method, a.files.database, a.files.prior);
  CheckOutputs({a.out, a.dynamics}, {a.skeletons, a.read.mapping_file, a.mechanics.scene});
  const std::optional<tracker::SceneOptions> scene = a.mechanics.Scene();
  for (const double weight : a.weights) {
    if (!(weight >= 0))
      throw UsageError(fmt::format("--weights: expected numbers from 0 up, found {}", weight));
  }
  a.read.stop = Interrupted;
  a.read.progress = ReadingBar(a.quiet);
  auto clips = recon::ReadSkeletonClips(a.skeletons, a.read);
  if (Interrupted()) throw InputError("reconstruct: interrupted; nothing was written");
  SayWarnings("reconstruct", clips);
  CheckDynamicsOf(a, clips.size());
  for (auto& clip : clips) a.floor.Apply(clip.sequence, a.quiet);
  const bool to_folder = GoesToFolder(a, clips);
  if (to_folder) {
    std::filesystem::create_directories(a.out);
  } else {
    CheckSkeletonName(a.out);
    AtomicFile::CheckWritable(a.out);
  }
  if (a.options.method != kButterworth) {
    a.options.database = tracker::LoadDatabase(a.files, a.options.method);
    a.options.prior = tracker::LoadPrior(a.files, a.options.method);
  }
  a.options.learned_file = LearnedFor(a, clips);
  const recon::SkeletonWriteOptions write = a.write.For(a.out);
  Progress progress("reconstruct", a.quiet);
  const int rounds = 1 + (a.bones.of_recording() ? 1 : 0) + (a.mechanics.on() || scene ? 1 : 0);
  double done = 0.0, total = 0.0;  // done: in all rounds
  for (const auto& clip : clips) total += static_cast<double>(clip.sequence.frames.size());
  size_t ready = 0, written = 0;  // frames of the clip at hand, and of all
  const auto update = [&](size_t frames) {
    ready = frames;
    progress.Update((done + static_cast<double>(frames)) / rounds, total);
    return !Interrupted();
  };
  for (const auto& clip : clips) {
    const auto frames = static_cast<double>(clip.sequence.frames.size());
    a.options.best.refined_joints = clip.sequence.sensor == recon::kRefinedJoints;
    recon::BoneLengthsById bones;
    if (a.bones.of_recording()) {
      bones = recon::MeasureBones(clip.sequence, a.options, update);
      done += frames;
    }
    auto made = a.options.method == kButterworth
                    ? recon::ButterworthSequence(clip.sequence, a.cutoff_hz)
                    : recon::ReconstructSequence(clip.sequence, a.options, update, bones);
    done += frames;
    made = recon::SmoothSequence(made, LagFor(a));  // before: the character keeps the floor
    if (scene) {
      ready = 0;
      PlayScene(*scene, made, a, update);
      done += frames;
    } else if (a.mechanics.on()) {
      ready = 0;
      tracker::FollowMechanically(made, a.mechanics.build, update);
      done += frames;
      if (!a.dynamics.empty() && !Interrupted()) {
        tracker::WriteDynamics(a.dynamics, made, a.mass_kg);
      }
    }
    if (Interrupted()) made.frames.resize(std::min(made.frames.size(), ready));
    if (made.frames.empty() && Interrupted()) break;
    std::filesystem::path to = a.out;
    if (to_folder) {
      to = to / (clip.name + ".jsonl");
      std::filesystem::create_directories(to.parent_path());
    }
    WriteSkeletonsThatFit(to, made, write);
    written += made.frames.size();
    if (Interrupted()) break;
  }
  if (Interrupted() && static_cast<double>(written) < total)
    throw InterruptedEarly(a, written, total);
  return 0;
}

}  // namespace ossa::commands
