#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "depth/base/atomic_file.h"
#include "depth/base/error.h"
#include "recon/body/standard_body.h"
#include "recon/database/posture_database.h"
#include "recon/motion/mocap.h"
#include "tools/commands/checks.h"
#include "tools/commands/command.h"
#include "tools/commands/commands.h"
#include "tools/commands/mapping_option.h"
#include "tools/commands/mocap_option.h"
#include "tools/commands/outputs.h"
#include "tools/commands/warnings.h"

namespace ossa::commands {
namespace {

std::vector<recon::PostureClip> ToPostures(const std::vector<recon::MotionClip>& clips,
                                           bool quiet) {
  Progress progress("postures", quiet);
  std::vector<recon::PostureClip> out;
  for (const recon::MotionClip& clip : clips) {
    recon::PostureClip& made = out.emplace_back();
    made.name = clip.name;
    for (const recon::RigPose& pose : clip.frames) {
      made.postures.push_back(recon::StandardPosture(pose));
      made.orientations.push_back(recon::ComputeOrientations(pose));
    }
    progress.Update(static_cast<double>(out.size()), static_cast<double>(clips.size()));
  }
  return out;
}

struct DatabaseArguments {
  std::vector<std::string> mocap;
  std::string out, filter = "max-joint";
  recon::DatabaseOptions options;
  recon::MocapOptions motion;
  bool quiet = false;
};

DatabaseArguments ParseArguments(int argc, char** argv) {
  CLI::App app("Build a posture database and its filtered pose graph from motion capture");
  DatabaseArguments a;
  AddMocapOption(app, a.mocap, a.motion);
  app.add_option("--out", a.out, "the .ossadb file to write")->required();
  app.add_option("--threshold", a.options.threshold_m,
                 "postures nearer than this to a kept one are dropped, metres")
      ->capture_default_str()
      ->check(CLI::Range(recon::kSmallestThreshold_m, recon::kLargestThreshold_m));
  app.add_option("--filter", a.filter, "distance of the filter")
      ->capture_default_str()
      ->check(CLI::IsMember({"sum-squared", "max-joint"}));
  app.add_option("--seed", a.motion.seed, "random seed of the authored clips' variation")
      ->capture_default_str();
  AddMappingOption(app, a.motion.mapping_file);
  app.add_flag("--quiet", a.quiet, "no progress");
  Parse(app, argc, argv);
  a.options.filter = a.filter == "max-joint" ? recon::DatabaseFilter::kMaxJoint
                                             : recon::DatabaseFilter::kSumSquared;
  return a;
}

void CheckOutput(const DatabaseArguments& a) {
  CheckNotOtherKind("--out", a.out, ".ossadb");
  std::vector<std::string> inputs = a.mocap;
  inputs.push_back(a.motion.mapping_file);
  CheckOutputs({a.out}, inputs);
  AtomicFile::CheckWritable(a.out);
}

void CheckNotInterrupted() {
  if (Interrupted()) throw InputError("database: interrupted; nothing was written");
}

}  // namespace

int Database(int argc, char** argv) {
  DatabaseArguments a = ParseArguments(argc, argv);
  CheckOutput(a);
  a.motion.stop = Interrupted;
  const auto motions = recon::LoadMocap(a.mocap, a.motion);
  CheckNotInterrupted();
  PrintWarnings("database", motions);
  const auto clips = ToPostures(motions, a.quiet);
  const auto database = recon::PostureDatabase::Build(clips, a.options, Interrupted);
  CheckNotInterrupted();
  database.Save(a.out);
  fmt::print("{}: {} postures of {} in {} clips, {:.1f} edges a posture\n", a.out, database.size(),
             database.source_postures(), database.clip_count(),
             static_cast<double>(database.edge_count()) / database.size());
  return 0;
}

}  // namespace ossa::commands
