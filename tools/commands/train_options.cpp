#include "tools/commands/train_options.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <array>

#include "depth/base/atomic_file.h"
#include "tools/commands/checks.h"
#include "tools/commands/command.h"
#include "tools/commands/outputs.h"
#include "tools/commands/train_card.h"

namespace ossa::commands {
namespace {

namespace fs = std::filesystem;

constexpr double kMostMegabytes = 1e6;  // MB, by hand: larger than any forest

// The arguments as written, before checks.
struct TrainWords {
  std::string memory = "8G";
  double max_megabytes = 0;
};

uint64_t ParseMemory(const std::string& text) {
  size_t used = 0;
  double number = 0;
  try {
    number = std::stod(text, &used);
  } catch (const std::exception&) {
    used = 0;
  }
  const std::string unit = text.substr(used);
  const double scale = unit == "G" ? 0x1p30 : unit == "M" ? 0x1p20 : unit == "K" ? 0x1p10 : 0;
  if (used == 0 || scale == 0 || !(number * scale >= 0x1p20) || number * scale > 0x1p50) {
    throw UsageError("--memory " + text + ": expected a number with K, M or G from 1M up, e.g. 8G");
  }
  return static_cast<uint64_t>(number * scale);
}

void AddForestOptions(CLI::App* app, forest::TrainOptions* options) {
  forest::TrainOptions& o = *options;
  app->add_option("--trees", o.trees, "trees of the forest")
      ->capture_default_str()
      ->check(CLI::Range(1, 16));
  app->add_option("--depth", o.depth, "levels of splits")
      ->capture_default_str()
      ->check(CLI::Range(1, 24));
  app->add_option("--candidates", o.candidates, "offset pairs tried per node")
      ->capture_default_str()
      ->check(CLI::Range(1, 100000));
  app->add_option("--thresholds", o.thresholds, "thresholds per candidate")
      ->capture_default_str()
      ->check(CLI::Range(2, 63));
  app->add_option("--pixels", o.pixels, "pixels per image and tree, balanced over the classes")
      ->capture_default_str()
      ->check(CLI::Range(1, 100000));
  app->add_option("--refill-pixels", o.refill_pixels,
                  "pixels per image that fill the leaves and votes (0: as --pixels)")
      ->capture_default_str()
      ->check(CLI::Range(0, 100000));
  app->add_option("--box", o.box_pixel_m, "longest offset, pixel metres at f = 575")
      ->capture_default_str()
      ->check(CLI::Range(1, 1999));
  app->add_option("--offsets", o.offsets, "distinct offsets per node; candidates are pairs of them")
      ->capture_default_str()
      ->check(CLI::Range(2, 4096));
}

void AddNodeOptions(CLI::App* app, forest::TrainOptions* options) {
  forest::TrainOptions& o = *options;
  app->add_option("--node-pixels", o.node_pixels, "maximum number of pixels evaluated per node")
      ->capture_default_str()
      ->check(CLI::Range(100, 1000000));
  app->add_option("--min-node-pixels", o.min_node_pixels, "nodes with fewer pixels are leaves")
      ->capture_default_str()
      ->check(CLI::Range(2, 1000000000));
  app->add_option("--min-gain", o.min_gain_bits,
                  "minimum information gain of a split, bits per pixel")
      ->capture_default_str()
      ->check(NotNegative());
  app->add_option("--context-share", o.context_share,
                  "share of the upper nodes that split by facing direction")
      ->capture_default_str()
      ->check(CLI::Range(0.0, 1.0));
  app->add_option("--vote-depth", o.vote_depth, "depth of the nodes that keep position votes")
      ->capture_default_str()
      ->check(CLI::Range(0, 18));
}

void AddDataOptions(CLI::App* app, TrainArguments* a, TrainWords* words) {
  app->add_option("--validation", a->validation,
                  "data sets for proposal parameters (default: 4 of each 100 frames, held out)");
  app->add_option("--validation-images", a->validation_images, "validation images to use")
      ->capture_default_str()
      ->check(Positive());
  app->add_option("--refinement", a->refinement,
                  "data sets of training subjects that no tree has seen: the second stage, which "
                  "corrects joint positions, is trained on them");
  app->add_option("--memory", words->memory, "memory for images; larger data are streamed in parts")
      ->capture_default_str();
  app->add_option("--max-megabytes", words->max_megabytes,
                  "maximum size of the file: the rarest leaf entries are dropped until it fits (0: "
                  "keep all)")
      ->check(CLI::Range(0.0, kMostMegabytes));
  app->add_option("--terms", a->terms, "terms of the data, for the model's card; repeat for more")
      ->allow_extra_args(false);
}

void AddSecondStageOptions(CLI::App* app, forest::RefinementOptions* options) {
  forest::RefinementOptions& o = *options;
  app->add_option("--refinement-units", o.hidden, "hidden units of the second stage")
      ->capture_default_str()
      ->check(CLI::Range(1, 1024));
  app->add_option("--refinement-epochs", o.epochs,
                  "passes of the second stage over its images, each also mirrored")
      ->capture_default_str()
      ->check(CLI::Range(1, 1000));
  app->add_option("--refinement-dropout", o.dropped,
                  "share of hidden units left out in each step: more for images unlike reality")
      ->capture_default_str()
      ->check(CLI::Range(0.0, 0.9));
}

void AddRunOptions(CLI::App* app, TrainArguments* a) {
  forest::TrainOptions& o = a->options;
  app->add_option("--seed", o.seed, "random seed")->capture_default_str();
  app->add_option("--threads", o.threads, "threads; 0: all cores")
      ->capture_default_str()
      ->check(CLI::Range(0, 1024));
  auto* resume = app->add_flag(
      "--resume", o.resume, "continue an interrupted run from OUT.checkpoint, with the same data");
  app->add_flag("--quiet", a->quiet, "no progress");
  auto* trees_of = app->add_option("--trees-of", a->trees_of,
                                   "keep the trees of this model; learn only the pose prior (on "
                                   "DATASET) and the proposals (on --validation). Without DATASET "
                                   "these are kept, too, and only the second stage is learned (on "
                                   "--refinement)");
  auto* import_pcl = app->add_option("--import-pcl", a->import_pcl,
                                     "convert PCL people trees (text) to a model instead of "
                                     "training; joint proposals are learned on --validation");
  trees_of->excludes(resume)->excludes(import_pcl);
  import_pcl->excludes(resume);
}

void AddOptions(CLI::App* app, TrainArguments* a, TrainWords* words) {
  app->add_option("DATASET", a->datasets, "labelled data sets (folders made by ossa render)");
  app->add_option("--out", a->out, "the model file to write")->required();
  AddForestOptions(app, &a->options);
  AddNodeOptions(app, &a->options);
  AddDataOptions(app, a, words);
  AddSecondStageOptions(app, &a->second_stage);
  AddRunOptions(app, a);
}

std::vector<std::string> ListInputs(const TrainArguments& a) {
  std::vector<std::string> inputs = {a.trees_of.string()};
  for (const auto* list : {&a.datasets, &a.validation, &a.refinement, &a.import_pcl}) {
    for (const fs::path& path : *list) inputs.push_back(path.string());
  }
  return inputs;
}

// Options without effect are errors, because the model would not be as requested. Only those of the
// command line: a user's defaults apply to all runs.
void CheckGoTogether(const CLI::App& app) {
  constexpr std::array kOfTrees = {
      "--trees",         "--depth",         "--candidates", "--thresholds",  "--pixels",
      "--refill-pixels", "--box",           "--offsets",    "--node-pixels", "--min-node-pixels",
      "--min-gain",      "--context-share", "--vote-depth", "--memory"};
  constexpr std::array kOfData = {"DATASET",
                                  "--refinement",
                                  "--refinement-units",
                                  "--refinement-epochs",
                                  "--refinement-dropout",
                                  "--terms"};
  const auto refuse = [&app](auto options, const char* with) {
    for (const char* option : options) {
      if (app.count(option) == 0 || app.count(with) == 0) continue;
      throw UsageError(fmt::format("{}: expected not with {}, which grows no trees", option, with));
    }
  };
  refuse(kOfTrees, "--trees-of");
  refuse(kOfTrees, "--import-pcl");
  refuse(kOfData, "--import-pcl");
}

void CheckHasData(const TrainArguments& a) {
  if (!a.datasets.empty() || !a.import_pcl.empty()) return;
  const bool is_second_stage_alone =
      !a.trees_of.empty() && !a.refinement.empty() && !a.validation.empty();
  if (is_second_stage_alone) return;
  throw UsageError(a.trees_of.empty()
                       ? "DATASET is required"
                       : "DATASET is required, or --refinement and --validation without it");
}

}  // namespace

TrainArguments ParseTrainOptions(int argc, char** argv) {
  CLI::App app("Train a body-part forest on labelled data sets");
  TrainArguments a;
  TrainWords words;
  a.command = DescribeCommand(argc, argv);
  AddOptions(&app, &a, &words);
  app.parse_complete_callback([&app] { CheckGoTogether(app); });
  Parse(app, argc, argv);
  CheckNotOtherKind("--out", a.out.string(), ".ossa");
  CheckOutputs({a.out.string()}, ListInputs(a));
  CheckHasData(a);
  a.options.memory_bytes = ParseMemory(words.memory);
  if (words.max_megabytes > 0) a.max_bytes = static_cast<uint64_t>(words.max_megabytes * 1e6);
  AtomicFile::CheckWritable(a.out);
  return a;
}

}  // namespace ossa::commands
