#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "depth/base/atomic_file.h"
#include "depth/base/error.h"
#include "depth/base/train_interrupted.h"
#include "forest/forest.h"
#include "forest/training/train.h"
#include "tools/commands/command.h"
#include "tools/commands/commands.h"
#include "tools/commands/outputs.h"
#include "tools/learning/learn_bone_estimation.h"
#include "tools/learning/learn_refinement_stage.h"
#include "tools/learning/refinement_examples.h"
#include "tools/tracker/shipped.h"

namespace ossa::commands {

int Refine(int argc, char** argv) {
  CLI::App app(
      "Train a stage of the cascade that refines a forest's joints at the depth image, on people "
      "that the forest was not trained on");
  std::vector<std::string> datasets;
  std::string out, after, model_path;
  tools::RefinementStageOptions options;
  bool bones = false, quiet = false;
  app.add_option("DATASET", datasets, "folders made by ossa render")->required();
  app.add_option("--out", out, "the .ossarefine file to write")->required();
  app.add_option(
      "--model", model_path,
      "forest model, .ossa (default: the shipped one, of people seen from the ceiling that for "
      "them)");
  app.add_option(
      "--after", after,
      "a .ossarefine: its stages come first, one more is learned from where they end; if "
      "it estimates bones, a bone-conditioned one (best on other people; the file "
      "counts those of its last stage)");
  app.add_flag("--bones", bones,
               "learn no stage but how long people's bones are, from where the stages of --after "
               "put the joints");
  app.add_option("--hidden", options.hidden,
                 "units of each network's first layer, half as many of its second")
      ->capture_default_str()
      ->check(CLI::Range(2, 1024));
  app.add_option("--epochs", options.epochs, "times that every person is read, from each place")
      ->capture_default_str()
      ->check(CLI::Range(1, 1000));
  app.add_option("--shifted", options.shifted,
                 "how often each person is read from places near where the joints are put, "
                 "besides from there")
      ->capture_default_str()
      ->check(CLI::Range(0, 100));
  app.add_option("--shift", options.shift_m, "how far off such a place is, metres along each axis")
      ->capture_default_str()
      ->check(CLI::Range(0.0, 0.5));
  app.add_option("--rate", options.rate, "of the learning, at its highest")
      ->capture_default_str()
      ->check(CLI::Range(1e-6, 0.1));
  app.add_option("--seed", options.seed, "of the learning")->capture_default_str();
  app.add_option("--threads", options.threads, "0: one a core")
      ->capture_default_str()
      ->check(CLI::Range(0, 1024));
  app.add_flag("--quiet", quiet, "no progress");
  Parse(app, argc, argv);
  if (!out.ends_with(".ossalook")) CheckNotOtherKind("--out", out, ".ossarefine");  // its old name
  if (bones && after.empty()) throw UsageError("--bones: expected --after FILE.ossarefine, too");
  if (bones && app.count("--shifted") + app.count("--shift") > 0) {
    throw UsageError("--shifted, --shift: bones are learned from joints where they are put");
  }
  std::vector<std::string> inputs = datasets;
  if (!model_path.empty()) inputs.push_back(model_path);
  if (!after.empty()) inputs.push_back(after);
  CheckOutputs({out}, inputs);
  AtomicFile::CheckWritable(out);

  if (!after.empty()) options.after = recon::RefinementCascade::Load(after);
  const recon::RefinementCascade& known = options.after;
  if (bones && !known.bone_conditioned.empty()) {
    throw InputError(fmt::format("{}: expected no bone-conditioned stage, found {}", after,
                                 known.bone_conditioned.size()));
  }
  const size_t stages = known.bones.empty() ? known.stages.size() : known.bone_conditioned.size();
  if (!bones && stages >= recon::RefinementCascade::kMaxStages) {
    throw InputError(fmt::format("{}: expected less than {} stages", after,
                                 recon::RefinementCascade::kMaxStages));
  }
  const bool from_above = tools::AreSeenFromAbove({datasets.begin(), datasets.end()});
  if (!after.empty() && from_above != known.from_above) {
    throw InputError(fmt::format("{}: learned on people seen {}, expected {} to show them so, too",
                                 after, known.from_above ? "from the ceiling" : "by a level camera",
                                 datasets.front()));
  }
  options.after.from_above = from_above;
  if (model_path.empty()) {
    model_path = tracker::ShippedFile(from_above ? "body_ceiling.ossa" : "body.ossa").string();
  }
  const forest::ForestModel model = forest::ReadForestModel(model_path);
  options.model_name = model_path;
  Progress bar("refine", quiet);
  options.stop = Interrupted;
  options.progress = [&](int64_t done, int64_t total) {
    bar.Update(static_cast<double>(done), static_cast<double>(total), "learning");
  };
  try {
    const auto learn = bones ? tools::LearnBoneEstimation : tools::LearnRefinementStage;
    const auto cascade = learn(model, {datasets.begin(), datasets.end()}, options);
    cascade.Save(out);
    fmt::print("{}: learned from {} people\n", out, bones ? cascade.measured : cascade.people);
  } catch (const TrainInterrupted&) {
    throw InputError("refine: interrupted; nothing was written");
  }
  return 0;
}

}  // namespace ossa::commands
