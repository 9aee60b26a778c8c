#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "depth/base/atomic_file.h"
#include "depth/base/checksummed_container.h"
#include "depth/base/error.h"
#include "depth/base/lower_case.h"
#include "depth/base/train_interrupted.h"
#include "forest/forest.h"
#include "forest/training/train.h"
#include "tools/commands/command.h"
#include "tools/commands/commands.h"
#include "tools/commands/outputs.h"
#include "tools/commands/parse_consistently.h"
#include "tools/commands/warnings.h"
#include "tools/learning/learn_bone_estimation.h"
#include "tools/learning/learn_refinement_stage.h"
#include "tools/learning/refinement_examples.h"
#include "tools/tracker/shipped.h"

namespace ossa::commands {

namespace {

struct RefineArguments {
  std::vector<std::string> datasets;
  std::string out, after, model_path;
  tools::RefinementStageOptions options;
  bool bones = false, quiet = false;
};

void AddFileOptions(CLI::App& app, RefineArguments& a) {
  app.add_option("DATASET", a.datasets, "folders made by ossa render")->required();
  app.add_option("--out", a.out, "the .ossarefine file to write")->required();
  app.add_option("--model", a.model_path,
                 "forest model, .ossa (default: the shipped one; for people seen from the ceiling, "
                 "the shipped one for these)");
  app.add_option("--after", a.after,
                 "a .ossarefine to which one more stage is added; if it estimates bone lengths, a "
                 "bone-conditioned one (best trained on other people)");
  app.add_flag("--bones", a.bones,
               "train the estimate of bone lengths instead of a stage, from the joints of --after");
}

void AddLearningOptions(CLI::App& app, tools::RefinementStageOptions& options) {
  app.add_option("--hidden", options.hidden,
                 "units of each network's first layer; the second has half as many")
      ->capture_default_str()
      ->check(CLI::Range(2, 1024));
  app.add_option("--epochs", options.epochs, "training epochs")
      ->capture_default_str()
      ->check(CLI::Range(1, 1000));
  app.add_option("--shifted", options.shifted,
                 "shifted copies of each sample, beside the one at the joint's position")
      ->capture_default_str()
      ->check(CLI::Range(0, 100));
  app.add_option("--shift", options.shift_m,
                 "standard deviation of the shift, metres along each axis")
      ->capture_default_str()
      ->check(CLI::Range(0.0, 0.5));
  app.add_option("--rate", options.rate, "peak learning rate")
      ->capture_default_str()
      ->check(CLI::Range(1e-6, 0.1));
  app.add_option("--seed", options.seed, "random seed of the training")->capture_default_str();
  app.add_option("--threads", options.threads, "threads; 0: one per core")
      ->capture_default_str()
      ->check(CLI::Range(0, 1024));
}

void Declare(CLI::App& app, RefineArguments& a) {
  AddFileOptions(app, a);
  AddLearningOptions(app, a.options);
  app.add_flag("--quiet", a.quiet, "no progress");
}

void CheckArguments(const CLI::App& app, RefineArguments& a) {
  // .ossalook: the former extension.
  if (!HasEnding(a.out, ".ossalook")) CheckNotOtherKind("--out", a.out, ".ossarefine");
  if (a.bones && a.after.empty())
    throw Contradiction("--bones: expected --after FILE.ossarefine, too");
  if (a.bones && app.count("--shifted") + app.count("--shift") > 0) {
    throw Contradiction("--shifted, --shift: bones are learned from joints where they are put");
  }
  std::vector<std::string> inputs = a.datasets;
  if (!a.model_path.empty()) inputs.push_back(a.model_path);
  if (!a.after.empty()) inputs.push_back(a.after);
  CheckOutputs({a.out}, inputs);
  AtomicFile::CheckWritable(a.out);
}

/// Throws InputError if no stage can be added after `known`.
void CheckStages(const RefineArguments& a, const recon::RefinementCascade& known) {
  if (a.bones && !known.bone_conditioned.empty()) {
    throw InputError(fmt::format("{}: expected no bone-conditioned stage, found {}", a.after,
                                 known.bone_conditioned.size()));
  }
  const size_t stages = known.bones.empty() ? known.stages.size() : known.bone_conditioned.size();
  if (!a.bones && stages >= recon::RefinementCascade::kMaxStages) {
    throw InputError(fmt::format("{}: expected less than {} stages", a.after,
                                 recon::RefinementCascade::kMaxStages));
  }
}

/// The stages before, for people with the view of the data sets.
recon::RefinementCascade LoadKnown(const RefineArguments& a) {
  recon::RefinementCascade known;
  if (!a.after.empty()) known = recon::RefinementCascade::Load(a.after);
  CheckStages(a, known);
  const bool from_above = tools::AreSeenFromAbove({a.datasets.begin(), a.datasets.end()});
  if (!a.after.empty() && from_above != known.from_above) {
    throw InputError(fmt::format(
        "{}: learned on people seen {}, expected {} to show them so, too", a.after,
        known.from_above ? "from the ceiling" : "by a level camera", a.datasets.front()));
  }
  known.from_above = from_above;
  return known;
}

std::string ModelPath(const RefineArguments& a) {
  if (!a.model_path.empty()) return a.model_path;
  const bool from_above = a.options.after.from_above;
  return tracker::ShippedFile(from_above ? "body_ceiling.ossa" : "body.ossa").string();
}

/// Sets the forest whose joints the cascade refines. Stages trained on those of another forest
/// would give wrong joints without an error.
uint64_t SetForestChecksum(const RefineArguments& a) {
  const uint64_t forest = ReadContainerChecksum(a.options.model_name);
  if (a.after.empty()) return forest;
  const uint64_t known = a.options.after.forest_checksum;
  if (known != 0 && known != forest) {
    PrintWarnings("refine",
                  std::vector<std::string>{fmt::format(
                      "{}: its stages were learned at the joints of another forest than {}",
                      a.after, a.options.model_name)});
  }
  return known == 0 ? 0 : forest;
}

}  // namespace

int Refine(int argc, char** argv) {
  auto a = ParseConsistently<RefineArguments>(
      {"Train a stage of the cascade that refines a forest's joints at the depth image, on people "
       "that the forest was not trained on",
       Declare, CheckArguments},
      argc, argv);
  a.options.after = LoadKnown(a);
  a.options.model_name = ModelPath(a);
  const forest::ForestModel model = forest::ReadForestModel(a.options.model_name);
  a.options.after.forest_checksum = SetForestChecksum(a);
  Progress bar("refine", a.quiet);
  a.options.stop = Interrupted;
  a.options.progress = [&](int64_t done, int64_t total) {
    bar.Update(static_cast<double>(done), static_cast<double>(total), "learning");
  };
  try {
    const auto learn = a.bones ? tools::LearnBoneEstimation : tools::LearnRefinementStage;
    const auto cascade = learn(model, {a.datasets.begin(), a.datasets.end()}, a.options);
    cascade.Save(a.out);
    fmt::print("{}: learned from {} people\n", a.out, a.bones ? cascade.measured : cascade.people);
  } catch (const TrainInterrupted&) {
    throw InputError("refine: interrupted; nothing was written");
  }
  return 0;
}

}  // namespace ossa::commands
