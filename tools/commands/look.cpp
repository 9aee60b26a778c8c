#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "depth/base/atomic_file.h"
#include "depth/base/error.h"
#include "forest/forest.h"
#include "forest/training/train.h"
#include "tools/commands/command.h"
#include "tools/commands/commands.h"
#include "tools/commands/outputs.h"
#include "tools/learning/learn_bone_measure.h"
#include "tools/learning/learn_close_look.h"
#include "tools/tracker/shipped.h"

namespace ossa::commands {

int Look(int argc, char** argv) {
  CLI::App app(
      "Learn to look again, closely, at where a forest puts the joints: on people that it was not "
      "trained on");
  std::vector<std::string> datasets;
  std::string out, after, model_path;
  tools::CloseLookOptions options;
  bool bones = false, quiet = false;
  app.add_option("DATASET", datasets, "folders made by ossa render")->required();
  app.add_option("--out", out, "the .ossalook file to write")->required();
  app.add_option("--model", model_path, "forest model, .ossa (default: the shipped one)");
  app.add_option("--after", after,
                 "a .ossalook: its glances come first, one more is learned from where they end; if "
                 "it measures bones, one that is told them (best of other people; the file counts "
                 "those of its last glance)");
  app.add_flag("--bones", bones,
               "learn no glance more but how long people's bones are, of where the glances of "
               "--after put the joints");
  app.add_option("--hidden", options.hidden,
                 "units of each network's first layer, half as many of its second")
      ->capture_default_str()
      ->check(CLI::Range(2, 1024));
  app.add_option("--epochs", options.epochs,
                 "times that every person is looked at, from each place")
      ->capture_default_str()
      ->check(CLI::Range(1, 1000));
  app.add_option("--shifted", options.shifted,
                 "how often each person is looked at from places near where the joints are put, "
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
  CheckNotOtherKind("--out", out, ".ossalook");
  if (bones && after.empty()) throw UsageError("--bones: expected --after LOOK, too");
  if (bones && app.count("--shifted") + app.count("--shift") > 0) {
    throw UsageError("--shifted, --shift: bones are learned of joints where they are put");
  }
  if (model_path.empty()) model_path = tracker::ShippedFile("body.ossa").string();
  std::vector<std::string> inputs = datasets;
  inputs.push_back(model_path);
  if (!after.empty()) inputs.push_back(after);
  CheckOutputs({out}, inputs);
  AtomicFile::CheckWritable(out);

  const forest::ForestModel model = forest::ReadForestModel(model_path);
  options.model_name = model_path;
  if (!after.empty()) options.after = recon::CloseLook::Load(after);
  const recon::CloseLook& known = options.after;
  if (bones && !known.told.empty()) {
    throw InputError(fmt::format("{}: expected no glance that is told of the bones, found {}",
                                 after, known.told.size()));
  }
  const size_t glances = known.bones.empty() ? known.glances.size() : known.told.size();
  if (!bones && glances >= recon::CloseLook::kMostGlances) {
    throw InputError(
        fmt::format("{}: expected less than {} glances", after, recon::CloseLook::kMostGlances));
  }
  Progress bar("look", quiet);
  options.stop = Interrupted;
  options.progress = [&](int64_t done, int64_t total) {
    bar.Update(static_cast<double>(done), static_cast<double>(total), "learning");
  };
  try {
    const auto learn = bones ? tools::LearnBoneMeasure : tools::LearnCloseLook;
    const auto look = learn(model, {datasets.begin(), datasets.end()}, options);
    look.Save(out);
    fmt::print("{}: learned from {} people\n", out, bones ? look.measured : look.people);
  } catch (const forest::TrainInterrupted&) {
    throw InputError("look: interrupted; nothing was written");
  }
  return 0;
}

}  // namespace ossa::commands
