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

constexpr double kMostMegabytes = 1e6;  // MB, by hand: no forest has as many

// As they are written, before they are checked.
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
  app->add_option("--candidates", o.candidates, "offset pairs tried a node")
      ->capture_default_str()
      ->check(CLI::Range(1, 100000));
  app->add_option("--thresholds", o.thresholds, "thresholds a candidate")
      ->capture_default_str()
      ->check(CLI::Range(2, 63));
  app->add_option("--pixels", o.pixels, "pixels an image and tree, balanced over its classes")
      ->capture_default_str()
      ->check(CLI::Range(1, 100000));
  app->add_option("--refill-pixels", o.refill_pixels,
                  "pixels an image that fill leaves and votes (0: as --pixels)")
      ->capture_default_str()
      ->check(CLI::Range(0, 100000));
  app->add_option("--box", o.box_pixel_m, "longest offset, pixel metres at f = 575")
      ->capture_default_str()
      ->check(CLI::Range(1, 1999));
  app->add_option("--offsets", o.offsets, "distinct offsets a node, candidates are pairs of them")
      ->capture_default_str()
      ->check(CLI::Range(2, 4096));
}

void AddNodeOptions(CLI::App* app, forest::TrainOptions* options) {
  forest::TrainOptions& o = *options;
  app->add_option("--node-pixels", o.node_pixels, "pixels looked at in a node, at most")
      ->capture_default_str()
      ->check(CLI::Range(100, 1000000));
  app->add_option("--min-node-pixels", o.min_node_pixels, "smaller nodes are leaves")
      ->capture_default_str()
      ->check(CLI::Range(2, 1000000000));
  app->add_option("--min-gain", o.min_gain_bits, "splits that gain fewer bits a pixel are not made")
      ->capture_default_str()
      ->check(NotNegative());
  app->add_option("--context-share", o.context_share,
                  "share of the upper nodes that split for the facing sector")
      ->capture_default_str()
      ->check(CLI::Range(0.0, 1.0));
  app->add_option("--vote-depth", o.vote_depth, "depth of the nodes that keep position votes")
      ->capture_default_str()
      ->check(CLI::Range(0, 18));
}

void AddDataOptions(CLI::App* app, TrainArguments* a, TrainWords* words) {
  app->add_option("--validation", a->validation,
                  "data sets for proposal parameters (default: 4 of each 100 frames, held out)");
  app->add_option("--validation-images", a->validation_images, "images of them to use")
      ->capture_default_str()
      ->check(Positive());
  app->add_option("--refinement", a->refinement,
                  "data sets of training subjects that no tree has seen: the second stage, which "
                  "moves joints to where they belong, is learned on them");
  app->add_option("--memory", words->memory, "for images; larger data stream in parts")
      ->capture_default_str();
  app->add_option("--max-megabytes", words->max_megabytes,
                  "leave the rarest leaf entries out until the file fits, of the grown trees and, "
                  "where what "
                  "is learned after them takes too much room, of the finished model (0: keep all)")
      ->check(CLI::Range(0.0, kMostMegabytes));
  app->add_option("--terms", a->terms, "terms of the data, for the model's card; repeat for more")
      ->allow_extra_args(false);
}

void AddRunOptions(CLI::App* app, TrainArguments* a) {
  forest::TrainOptions& o = a->options;
  app->add_option("--seed", o.seed, "of every random choice")->capture_default_str();
  app->add_option("--threads", o.threads, "0: all cores")
      ->capture_default_str()
      ->check(CLI::Range(0, 1024));
  auto* resume = app->add_flag(
      "--resume", o.resume,
      "go on from OUT.checkpoint where a run was cut off; of the same data done is done");
  app->add_flag("--quiet", a->quiet, "no progress");
  auto* trees_of =
      app->add_option("--trees-of", a->trees_of,
                      "keep the trees of this model; learn only how joints lie to each other (on "
                      "DATASET) and the proposals (on --validation)");
  auto* import_pcl =
      app->add_option("--import-pcl", a->import_pcl,
                      "make a model of PCL people trees (text) instead of training; proposals of "
                      "joints are learned on --validation");
  trees_of->excludes(resume)->excludes(import_pcl);
  import_pcl->excludes(resume);
}

void AddOptions(CLI::App* app, TrainArguments* a, TrainWords* words) {
  app->add_option("DATASET", a->datasets, "labelled data sets (folders made by ossa render)");
  app->add_option("--out", a->out, "the model file to write")->required();
  AddForestOptions(app, &a->options);
  AddNodeOptions(app, &a->options);
  AddDataOptions(app, a, words);
  AddRunOptions(app, a);
}

std::vector<std::string> ListInputs(const TrainArguments& a) {
  std::vector<std::string> inputs = {a.trees_of.string()};
  for (const auto* list : {&a.datasets, &a.validation, &a.refinement, &a.import_pcl}) {
    for (const fs::path& path : *list) inputs.push_back(path.string());
  }
  return inputs;
}

// What a run has no use for is a mistake: it would leave the model other than was asked for. Of the
// command line alone: defaults of a user's own are for all runs.
void CheckGoTogether(const CLI::App& app) {
  constexpr std::array kOfTrees = {
      "--trees",         "--depth",         "--candidates", "--thresholds",  "--pixels",
      "--refill-pixels", "--box",           "--offsets",    "--node-pixels", "--min-node-pixels",
      "--min-gain",      "--context-share", "--vote-depth", "--memory"};
  constexpr std::array kOfData = {"DATASET", "--refinement", "--terms"};
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
  if (a.import_pcl.empty() && a.datasets.empty()) throw UsageError("DATASET is required");
  a.options.memory_bytes = ParseMemory(words.memory);
  if (words.max_megabytes > 0) a.max_bytes = static_cast<uint64_t>(words.max_megabytes * 1e6);
  AtomicFile::CheckWritable(a.out);
  return a;
}

}  // namespace ossa::commands
