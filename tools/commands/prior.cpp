#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <string>
#include <utility>
#include <vector>

#include "depth/base/atomic_file.h"
#include "depth/base/error.h"
#include "depth/base/train_interrupted.h"
#include "forest/training/train.h"
#include "recon/body/standard_body.h"
#include "recon/models/posture_prior.h"
#include "recon/motion/mocap.h"
#include "tools/commands/command.h"
#include "tools/commands/commands.h"
#include "tools/commands/mapping_option.h"
#include "tools/commands/mocap_option.h"
#include "tools/commands/outputs.h"
#include "tools/commands/warnings.h"
#include "tools/learning/learn_prior_network.h"

namespace ossa::commands {
namespace {

bool IsAuthored(const recon::MotionClip& motion) {
  return motion.name.starts_with("authored/") || motion.name.starts_with("authored-floor/");
}

std::vector<recon::PriorClip> ToPriorClips(const std::vector<recon::MotionClip>& motions,
                                           double authored_weight) {
  std::vector<recon::PriorClip> clips;
  for (const recon::MotionClip& motion : motions) {
    recon::PriorClip& clip = clips.emplace_back();
    clip.frame_s = motion.frame_s;
    clip.weight = IsAuthored(motion) ? authored_weight : 1.0;
    for (const recon::RigPose& pose : motion.frames) {
      clip.postures.push_back(recon::StandardPosture(pose));
    }
  }
  return clips;
}

struct PriorArguments {
  std::vector<std::string> mocap;
  std::string out;
  recon::PosturePriorOptions options;
  recon::MocapOptions mocap_options;
  double authored_weight = 0.3;
  tools::PriorNetworkOptions network;
  bool quiet = false;
};

void AddNetworkOptions(CLI::App& app, tools::PriorNetworkOptions& network) {
  app.add_option("--hidden", network.hidden,
                 "hidden units of the network that corrects the modes' prediction; 0: none")
      ->capture_default_str()
      ->check(CLI::Range(0, 1024));
  app.add_option("--epochs", network.epochs, "training epochs of the network")
      ->capture_default_str()
      ->check(CLI::Range(1, 1000));
  app.add_option("--walks", network.walks,
                 "passes through each motion of weight 1 in the network's training, with other "
                 "joints hidden each time")
      ->capture_default_str()
      ->check(CLI::Range(1, 1000));
}

void DeclareOptions(CLI::App& app, PriorArguments& a) {
  AddMocapOption(app, a.mocap, a.mocap_options);
  app.add_option("--out", a.out, "the .ossaprior file to write")->required();
  app.add_option("--modes", a.options.modes, "number of independent modes of motion")
      ->capture_default_str()
      ->check(CLI::Range(1, recon::kBoneDims));
  app.add_option("--authored-weight", a.authored_weight,
                 "weight of an authored frame relative to a captured one")
      ->capture_default_str()
      ->check(CLI::Range(0.001, 100.0));
  AddNetworkOptions(app, a.network);
  app.add_option("--seed", a.mocap_options.seed,
                 "random seed of the authored clips' variation and of the hidden joints")
      ->capture_default_str();
  app.add_option("--threads", a.network.threads, "threads; 0: one per core")
      ->capture_default_str()
      ->check(CLI::Range(0, 1024));
  app.add_flag("--quiet", a.quiet, "no progress");
  AddMappingOption(app, a.mocap_options.mapping_file);
}

void CheckFiles(const PriorArguments& a) {
  CheckNotOtherKind("--out", a.out, ".ossaprior");
  std::vector<std::string> inputs = a.mocap;
  inputs.push_back(a.mocap_options.mapping_file);
  CheckOutputs({a.out}, inputs);
  AtomicFile::CheckWritable(a.out);
}

recon::PosturePrior LearnNetwork(recon::PosturePrior prior,
                                 const std::vector<recon::PriorClip>& clips, PriorArguments& a) {
  Progress bar("prior", a.quiet);
  a.network.seed = a.mocap_options.seed;
  a.network.stop = Interrupted;
  a.network.progress = [&](int64_t done, int64_t total) {
    bar.Update(static_cast<double>(done), static_cast<double>(total), "learning the network");
  };
  try {
    prior.network = tools::LearnPriorNetwork(prior, clips, a.network);
  } catch (const TrainInterrupted&) {
    throw InputError("prior: interrupted; nothing was written");
  }
  return prior;
}

}  // namespace

int Prior(int argc, char** argv) {
  CLI::App app(
      "Learn a pose prior from motion capture: which postures are likely, and how fast they "
      "change");
  PriorArguments a;
  DeclareOptions(app, a);
  Parse(app, argc, argv);
  CheckFiles(a);
  a.mocap_options.stop = Interrupted;
  const auto motions = recon::LoadMocap(a.mocap, a.mocap_options);
  PrintWarnings("prior", motions);
  const auto clips = ToPriorClips(motions, a.authored_weight);
  if (Interrupted()) throw InputError("prior: interrupted; nothing was written");
  auto prior = recon::PosturePrior::Learn(clips, a.options);
  if (a.network.hidden > 0) prior = LearnNetwork(std::move(prior), clips, a);
  prior.Save(a.out);
  fmt::print("{}: {} modes learned from {} postures in {} clips\n", a.out,
             prior.correlation_time_s.size(), prior.frames, clips.size());
  return 0;
}

}  // namespace ossa::commands
