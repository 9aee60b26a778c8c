#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>

#include "depth/base/atomic_file.h"
#include "depth/base/error.h"
#include "depth/base/perceptron/train_perceptron.h"
#include "depth/base/train_interrupted.h"
#include "forest/import_pcl.h"
#include "forest/prune.h"
#include "forest/training/mpi_reducer.h"
#include "forest/training/train.h"
#include "tools/commands/checks.h"
#include "tools/commands/command.h"
#include "tools/commands/commands.h"
#include "tools/commands/outputs.h"
#include "tools/commands/process.h"
#include "tools/json/json_text.h"
#include "tools/learning/common_parts.h"
#include "tools/learning/person_source.h"

namespace ossa::commands {
namespace {

namespace fs = std::filesystem;

struct TrainArguments {
  std::vector<fs::path> datasets;
  std::vector<fs::path> validation;
  std::vector<fs::path> refinement;
  std::vector<fs::path> import_pcl;
  fs::path trees_of;
  fs::path out;
  std::string memory = "8G";
  std::string command;
  bool quiet = false;
  double max_megabytes = 0;
  std::vector<std::string> terms;
  size_t validation_images = 800;
  forest::TrainOptions options;
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

void AddOptions(CLI::App* app, TrainArguments* a) {
  forest::TrainOptions& o = a->options;
  app->add_option("DATASET", a->datasets, "labelled data sets (folders made by ossa render)");
  app->add_option("--out", a->out, "the model file to write")->required();
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
  app->add_option("--validation", a->validation,
                  "data sets for proposal parameters (default: 4 of each 100 frames, held out)");
  app->add_option("--validation-images", a->validation_images, "images of them to use")
      ->capture_default_str()
      ->check(Positive());
  app->add_option("--refinement", a->refinement,
                  "data sets of training subjects that no tree has seen: the second stage, which "
                  "moves joints to where they belong, is learned on them");
  app->add_option("--memory", a->memory, "for images; larger data stream in parts")
      ->capture_default_str();
  app->add_option("--max-megabytes", a->max_megabytes,
                  "leave the rarest leaf entries out until the file fits (0: keep all)")
      ->check(NotNegative());
  app->add_option("--terms", a->terms, "terms of the data, for the model's card; repeat for more")
      ->allow_extra_args(false);
  app->add_option("--seed", o.seed, "of every random choice")->capture_default_str();
  app->add_option("--threads", o.threads, "0: all cores")
      ->capture_default_str()
      ->check(CLI::Range(0, 1024));
  auto* resume =
      app->add_flag("--resume", o.resume, "go on from OUT.checkpoint where a run was cut off");
  app->add_flag("--quiet", a->quiet, "no progress");
  auto* trees_of =
      app->add_option("--trees-of", a->trees_of,
                      "keep the trees of this model; learn only how joints lie to each other (on "
                      "DATASET) and the proposals (on --validation)");
  auto* import_pcl = app->add_option(
      "--import-pcl", a->import_pcl,
      "make a model of PCL people trees (text, up to 4) instead of training; proposals of "
      "joints are learned on --validation");
  trees_of->excludes(resume)->excludes(import_pcl);
  import_pcl->excludes(resume);
}

void ShowProgress(Progress* bar, const forest::TrainProgress& p) {
  const double total = p.trees * p.levels;
  if (p.level < 0) return bar->Update(0, total, "reading");
  if (p.level >= p.levels) return bar->Update(total - 1, total, "filling leaves and votes");
  bar->Update(
      p.tree * p.levels + p.level + 1, total,
      fmt::format("tree {} level {} nodes {} gain {:.3f} bits {:.0f} M evaluations/s {:.0f} "
                  "s left",
                  p.tree + 1, p.level + 1, p.nodes, p.mean_gain, p.evaluations_per_s * 1e-6,
                  p.seconds_left));
}

// Only names of files, not where they lay: a card travels.
std::string WithoutFolders(const std::string& line) {
  std::istringstream words(line);
  std::string out;
  std::string word;
  while (words >> word) {
    if (!out.empty()) out += ' ';
    const bool is_path = word.find('/') != std::string::npos;
    out += is_path ? fs::path(word).filename().string() : word;
  }
  return out;
}

// FNV-1a, 64 bits: names the data, guards nothing.
uint64_t Fnv1a(const std::string& text) {
  uint64_t hash = 0xcbf29ce484222325ULL;
  for (const char c : text) hash = (hash ^ static_cast<uint8_t>(c)) * 0x100000001b3ULL;
  return hash;
}

// What the data sets say of their terms, each once, and what --terms adds.
std::vector<std::string> AllTerms(const TrainArguments& a, const tools::PersonSource& source) {
  std::vector<std::string> all = a.terms;
  for (const tools::DatasetManifest& m : source.manifests()) {
    for (const std::string& terms : m.terms) {
      const bool known = std::find(all.begin(), all.end(), terms) != all.end();
      if (!known && terms.find('/') == std::string::npos) all.push_back(terms);
    }
  }
  return all;
}

nlohmann::ordered_json DescribeData(const std::vector<tools::DatasetManifest>& manifests) {
  auto data = nlohmann::ordered_json::array();
  for (const tools::DatasetManifest& m : manifests) {
    data.push_back({{"command", WithoutFolders(m.command)}, {"frames", m.frames}});
  }
  return data;
}

void NoteRefinement(const TrainArguments& a, nlohmann::ordered_json* card) {
  if (a.refinement.empty()) return;
  (*card)["refinement_data"] =
      DescribeData(tools::PersonSource(a.refinement, {0, 100}).manifests());
}

nlohmann::ordered_json Card(const TrainArguments& a, const tools::PersonSource& source,
                            const forest::TrainSummary& summary) {
  nlohmann::ordered_json card;
  card["command"] = a.command;
  card["data"] = DescribeData(source.manifests());
  NoteRefinement(a, &card);
  card["terms"] = AllTerms(a, source);
  card["data_hash"] = fmt::format("{:016x}", Fnv1a(source.fingerprint()));
  card["images"] = summary.images;
  card["class_balance"] = "equal shares of the classes present in each image";
  return card;
}

// Of the levels this run grew; a time, so that it has no place in a card.
void SayRate(const forest::TrainSummary& summary) {
  if (summary.split_seconds <= 0) return;
  const auto evaluations = static_cast<double>(summary.evaluations);
  Say(fmt::format("train: {} images, {:.3g} evaluations, {:.0f} M a second\n", summary.images,
                  evaluations, 1e-6 * evaluations / summary.split_seconds));
}

// With validation frames the trees also get proposals, to be evaluated like a model of ours.
int ImportPcl(const TrainArguments& a) {
  forest::ForestModel model = forest::ImportPclTrees(a.import_pcl);
  if (!a.validation.empty()) {
    forest::ForestData data = model.data();
    data.targets = tools::PclTargets(data.class_names);
    model = forest::LearnProposals(forest::ForestModel(std::move(data)),
                                   tools::PersonSource(a.validation, {0, 100}), a.validation_images,
                                   a.options.threads);
  }
  forest::WriteForestModel(a.out, model);
  return 0;
}

// Constants: chosen by hand.

constexpr size_t kArrangedImages = 40000;  // 60 numbers in 8 contexts ask for no more

constexpr int kForLabels = 10;  // of each 100 fresh frames; the refinement has the others

// The second stage; how far it is to be trusted; and what its joints say of the labels.
forest::ForestModel Refined(const TrainArguments& a, const forest::ForestModel& model,
                            const tools::PersonSource& held_out) {
  const tools::PersonSource fresh(a.refinement, {kForLabels, 100}, tools::Extent::kWholeImage);
  const tools::PersonSource fresher(a.refinement, {0, kForLabels}, tools::Extent::kWholeImage);
  Progress bar("refinement", a.quiet);
  forest::RefinementOptions options;
  options.seed = a.options.seed;
  options.threads = a.options.threads;
  options.stop = Interrupted;
  options.progress = [&](int64_t done, int64_t total) {
    bar.Update(static_cast<double>(done), static_cast<double>(total));
  };
  const forest::ForestModel refined =
      forest::LearnRefinement(model, tools::MirroredSource(fresh), options);
  const forest::ForestModel sure =
      forest::LearnConfidences(refined, held_out, a.validation_images, a.options.threads);
  return forest::LearnRelabelling(sure, fresher, a.options.seed, a.options.threads);
}

// Hours before they are needed.
void CheckRefinement(const TrainArguments& a) {
  if (a.refinement.empty()) return;
  const tools::PersonSource fresh(a.refinement, {kForLabels, 100}, tools::Extent::kWholeImage);
  const auto images = static_cast<Eigen::Index>(2 * fresh.size());  // mirrored, too
  if (images >= kPerceptronBatch) return;
  throw InputError(fmt::format("{}: expected at least {} images for --refinement, found {}",
                               a.refinement.front().string(),
                               kPerceptronBatch * 100 / (2 * (100 - kForLabels)) + 1,
                               fresh.size() * 100 / (100 - kForLabels)));
}

forest::ForestModel LearnJoints(const TrainArguments& a, const forest::ForestModel& model,
                                const tools::PersonSource& source,
                                const tools::PersonSource& held_out) {
  const int threads = a.options.threads;
  const forest::ForestModel arranged =
      forest::LearnPosePriors(model, source, kArrangedImages, threads);
  if (held_out.size() == 0) return arranged;
  const forest::ForestModel proposing =
      forest::LearnProposals(arranged, held_out, a.validation_images, threads);
  return a.refinement.empty() ? proposing : Refined(a, proposing, held_out);
}

// Training images and those held out for proposals.
struct Sources {
  tools::PersonSource training;
  tools::PersonSource held_out;

  explicit Sources(const TrainArguments& a)
      : training(a.datasets, {a.validation.empty() ? kHeldOut : 0, 100}),
        held_out(a.validation.empty() ? a.datasets : a.validation,
                 {0, a.validation.empty() ? kHeldOut : 100}, tools::Extent::kWholeImage) {}

  static constexpr int kHeldOut = 4;  // of each 100 frames
};

int LearnAgain(const TrainArguments& a) {
  const forest::ForestModel old = forest::ReadForestModel(a.trees_of);
  const Sources sources(a);
  forest::ForestData data = LearnJoints(a, old, sources.training, sources.held_out).data();
  auto card = nlohmann::ordered_json::parse(old.manifest(), nullptr, false);
  if (card.is_object()) {
    card["proposals_command"] = a.command;
    card.erase("accuracy");  // of the proposals as they were
    card.erase("refinement_data");
    NoteRefinement(a, &card);
    data.manifest = tools::JsonText(card);
  }
  forest::WriteForestModel(a.out, forest::ForestModel(std::move(data)));
  return 0;
}

int TrainOnData(TrainArguments* a, const forest::Reducer& reducer) {
  forest::TrainOptions& o = a->options;
  const Sources sources(*a);
  const tools::PersonSource& source = sources.training;
  o.fingerprint = source.fingerprint();
  o.checkpoint = a->out.string() + ".checkpoint";
  if (reducer.rank() == 0) AtomicFile::CheckWritable(o.checkpoint);
  o.stop = Interrupted;
  Progress bar("train", a->quiet || reducer.rank() != 0);
  o.progress = [&](const forest::TrainProgress& p) { ShowProgress(&bar, p); };
  forest::TrainSummary summary;
  forest::ForestModel model = forest::Train(source, tools::BodyVocabulary(), o, reducer, &summary);
  if (reducer.rank() != 0) return 0;
  if (!a->quiet) SayRate(summary);
  if (a->max_megabytes > 0) {
    model = forest::FitInto(model, static_cast<uint64_t>(a->max_megabytes * 1e6));
  }
  forest::ForestData data = LearnJoints(*a, model, source, sources.held_out).data();
  data.manifest = tools::JsonText(Card(*a, source, summary));
  forest::WriteForestModel(a->out, forest::ForestModel(std::move(data)));
  fs::remove(o.checkpoint);
  return 0;
}

std::vector<std::string> ListInputs(const TrainArguments& a) {
  std::vector<std::string> inputs = {a.trees_of.string()};
  for (const auto* list : {&a.datasets, &a.validation, &a.refinement, &a.import_pcl}) {
    for (const fs::path& path : *list) inputs.push_back(path.string());
  }
  return inputs;
}

std::string CommandLine(int argc, char** argv) {
  // Without what leaves the model as it is: the same bytes however it was trained.
  std::string line = "ossa";
  for (int i = 0; i < argc; ++i) {
    const std::string word = argv[i];
    if (word == "--resume" || word == "--quiet") continue;
    if (word == "--threads" || word == "--memory" || word == "--out") {
      ++i;
      continue;
    }
    line.append(1, ' ').append(word);
  }
  return WithoutFolders(line);
}

}  // namespace

int Train(int argc, char** argv) {
  const auto reducer = forest::MakeMpiReducer(&argc, &argv);
  CLI::App app("Train a body-part forest on labelled data sets");
  TrainArguments arguments;
  arguments.command = CommandLine(argc, argv);
  AddOptions(&app, &arguments);
  Parse(app, argc, argv);
  CheckNotOtherKind("--out", arguments.out.string(), ".ossa");
  CheckOutputs({arguments.out.string()}, ListInputs(arguments));
  AtomicFile::CheckWritable(arguments.out);
  if (!arguments.import_pcl.empty()) return ImportPcl(arguments);
  if (arguments.datasets.empty()) throw UsageError("DATASET is required");
  CheckRefinement(arguments);
  if (!arguments.trees_of.empty()) return LearnAgain(arguments);
  arguments.options.memory_bytes = ParseMemory(arguments.memory);
  try {
    return TrainOnData(&arguments, *reducer);
  } catch (const TrainInterrupted& interruption) {
    const fs::path checkpoint = arguments.out.string() + ".checkpoint";
    if (!fs::exists(checkpoint)) throw;
    throw InputError(fmt::format("train: {}: the same command with --resume goes on from {}",
                                 interruption.what(), checkpoint.string()));
  }
}

}  // namespace ossa::commands
