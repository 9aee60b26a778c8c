#include "forest/training/train.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <optional>

#include "depth/base/error.h"
#include "depth/base/stopwatch.h"
#include "depth/base/threads.h"
#include "forest/training/checkpoint_internal.h"
#include "forest/training/grow_internal.h"
#include "forest/training/leaves_internal.h"

namespace ossa::forest {
namespace {

void Require(bool holds, const std::string& name, double value, const std::string& range) {
  if (holds) return;
  throw std::invalid_argument("TrainOptions." + name + " = " + std::to_string(value) +
                              ", must be in " + range);
}

// The shortest text that round-trips the number.
template <typename Number>
std::string ToText(Number number) {
  std::array<char, 32> text{};
  const auto [end, error] = std::to_chars(text.data(), text.data() + text.size(), number);
  return {text.data(), end};
}

// All settings that affect the bytes of the model: not threads, memory or ranks.
std::vector<Setting> MakeSettings(const TrainOptions& o, const TrainingSource& source) {
  return {{"data", o.fingerprint},
          {"images", ToText(source.size())},
          {"trees", ToText(o.trees)},
          {"depth", ToText(o.depth)},
          {"candidates", ToText(o.candidates)},
          {"thresholds", ToText(o.thresholds)},
          {"pixels", ToText(o.pixels)},
          {"refill-pixels", ToText(o.refill_pixels)},
          {"offsets", ToText(o.offsets)},
          {"box", ToText(o.box_pixel_m)},
          {"node-pixels", ToText(o.node_pixels)},
          {"min-node-pixels", ToText(o.min_node_pixels)},
          {"min-gain", ToText(o.min_gain_bits)},
          {"context-share", ToText(o.context_share)},
          {"vote-depth", ToText(o.vote_depth)},
          {"seed", ToText(o.seed)}};
}

// State of a training run over all levels.
class Run {
 public:
  Run(const TrainingSource& source, const TrainingVocabulary& vocabulary,
      const TrainOptions& options, const Reducer& reducer, TrainSummary* summary)
      : vocabulary_(vocabulary), options_(options), reducer_(reducer), summary_(summary) {
    checkpoint_.settings = MakeSettings(options, source);
    if (options.resume && !options.checkpoint.empty() &&
        std::filesystem::exists(options.checkpoint)) {
      checkpoint_ = ReadCheckpoint(options.checkpoint, checkpoint_.settings);
    }
    Report(-1, {}, 0);
    parts_.emplace(source, options, vocabulary.class_names.size(), reducer);
    images_ = {static_cast<int64_t>(parts_->image_count())};
    reducer.Sum(std::span<int64_t>(images_));
    if (images_[0] == 0) throw InputError("training data: no image shows a labelled object");
    CheckClasses();
  }

  std::vector<Tree> Grow() {
    while (checkpoint_.finished.size() < static_cast<size_t>(options_.trees)) GrowTree();
    std::vector<Tree> trees;
    for (const auto& nodes : checkpoint_.finished) {
      trees.push_back(NumberLeaves(nodes, options_.vote_depth));
    }
    Report(options_.depth, {}, 0);
    FillLeaves(*parts_, reducer_, vocabulary_.class_names.size(), vocabulary_.context_names.size(),
               vocabulary_.targets.size(), &trees);
    return trees;
  }

  // Balanced, as leaves are filled with balanced contexts.
  std::vector<float> ContextPrior() const {
    std::vector<int64_t> counts;
    for (size_t k = 0; k < vocabulary_.context_names.size(); ++k) {
      counts.push_back(static_cast<int64_t>(parts_->context_count(k)));
    }
    reducer_.Sum(std::span<int64_t>(counts));
    std::vector<float> prior;
    const auto present =
        std::count_if(counts.begin(), counts.end(), [](int64_t n) { return n > 0; });
    for (const int64_t n : counts) {
      prior.push_back(n > 0 ? 1.0F / static_cast<float>(present) : 0.0F);
    }
    return prior;
  }

  int64_t image_count() const { return images_[0]; }

 private:
  void CheckClasses() {
    std::vector<int64_t> present(vocabulary_.class_names.size(), 0);
    parts_->Visit([&](size_t, const std::vector<StoredImage>& images) {
      for (const StoredImage& image : images) {
        if (image.context >= vocabulary_.context_names.size()) {
          throw InputError("training image " + std::to_string(image.index) +
                           ": context of unknown number");
        }
        for (const PixelSample& sample : image.samples) ++present[sample.label];
      }
    });
    reducer_.Sum(std::span<int64_t>(present));
    const auto classes =
        std::count_if(present.begin(), present.end(), [](auto n) { return n > 0; });
    if (classes < 2) {
      throw InputError("training data: only one class occurs; nothing can be learned from it");
    }
  }

  void GrowTree() {
    const auto number = static_cast<int>(checkpoint_.finished.size());
    TreeGrower grower(*parts_, options_, reducer_, vocabulary_.class_names.size(),
                      vocabulary_.context_names.size(), number);
    GrowingTree& tree = checkpoint_.growing;
    grower.Place(tree);
    while (tree.level < options_.depth && tree.frontier_begin < tree.nodes.size()) {
      const LevelReport report = grower.GrowLevel(&tree);
      if (summary_ != nullptr) {
        summary_->evaluations += report.evaluations;
        summary_->split_seconds += report.seconds;
      }
      Report(tree.level - 1, report, report.seconds);
      if (tree.level < options_.depth) Save();
    }
    if (summary_ != nullptr) summary_->pixels += grower.sample_count();
    checkpoint_.finished.push_back(std::move(tree.nodes));
    checkpoint_.growing = GrowingTree{};
    Save();
  }

  void Save() const {
    if (options_.checkpoint.empty() || reducer_.rank() != 0) return;
    WriteCheckpoint(options_.checkpoint, checkpoint_);
  }

  // Levels below the tenth use all pixels and have about equal cost; those above use a sample.
  void Report(int level, const LevelReport& report, double level_s) const {
    if (!options_.progress || reducer_.rank() != 0) return;
    TrainProgress progress;
    progress.tree = static_cast<int>(checkpoint_.finished.size());
    progress.trees = options_.trees;
    progress.level = level;
    progress.levels = options_.depth;
    progress.nodes = report.frontier;
    progress.mean_gain = report.mean_gain_bits;
    if (report.seconds > 0) {
      progress.evaluations_per_s = static_cast<double>(report.evaluations) / report.seconds;
    }
    constexpr int kCheapLevels = 9;  // for speed
    const int costly = std::max(1, options_.depth - kCheapLevels);
    const int left = std::max(0, options_.depth - 1 - std::max(level, kCheapLevels - 1)) +
                     costly * (options_.trees - 1 - progress.tree);
    progress.seconds_left = level_s * left;
    options_.progress(progress);
  }

  const TrainingVocabulary& vocabulary_;
  const TrainOptions& options_;
  const Reducer& reducer_;
  TrainSummary* summary_;
  Checkpoint checkpoint_;
  std::optional<ImageParts> parts_;
  std::vector<int64_t> images_;
};

}  // namespace

void TrainOptions::Check() const {
  Require(trees >= 1 && trees <= 16, "trees", trees, "[1, 16]");
  Require(depth >= 1 && depth <= 24, "depth", depth, "[1, 24]");
  Require(candidates >= 1 && candidates <= 100000, "candidates", candidates, "[1, 100000]");
  Require(thresholds >= 2 && thresholds <= 63, "thresholds", thresholds, "[2, 63]");
  Require(pixels >= 1 && pixels <= 100000, "pixels", pixels, "[1, 100000]");
  Require(refill_pixels >= 0 && refill_pixels <= 100000, "refill_pixels", refill_pixels,
          "[0, 100000]");
  Require(offsets >= 2 && offsets <= 4096, "offsets", offsets, "[2, 4096]");
  Require(box_pixel_m > 0 && box_pixel_m < 2000, "box_pixel_m", box_pixel_m, "(0, 2000)");
  Require(node_pixels >= 100 && node_pixels <= 1000000, "node_pixels", node_pixels,
          "[100, 1000000]");
  Require(min_node_pixels >= 2, "min_node_pixels", min_node_pixels, "[2, ...)");
  Require(min_gain_bits >= 0, "min_gain_bits", min_gain_bits, "[0, ...)");
  Require(context_share >= 0 && context_share <= 1, "context_share", context_share, "[0, 1]");
  Require(vote_depth >= 0 && vote_depth <= 18, "vote_depth", vote_depth, "[0, 18]");
  Require(threads >= 0 && threads <= 1024, "threads", threads, "[0, 1024]");
  Require(memory_bytes >= (uint64_t{1} << 20U), "memory_bytes", static_cast<double>(memory_bytes),
          "[1 MiB, ...)");
}

ForestModel Train(const TrainingSource& source, const TrainingVocabulary& vocabulary,
                  const TrainOptions& options, const Reducer& reducer, TrainSummary* summary) {
  options.Check();
  const Stopwatch watch;
  const ThreadLimit limit(options.threads);
  Run run(source, vocabulary, options, reducer, summary);
  ForestData data;
  data.trees = run.Grow();
  data.class_names = vocabulary.class_names;
  data.context_names = vocabulary.context_names;
  data.context_prior = run.ContextPrior();
  data.background_mm = kBackground_mm;
  data.targets = vocabulary.targets;
  data.manifest = "{}";
  ForestModel model(std::move(data));
  if (summary != nullptr) {
    summary->images = static_cast<uint64_t>(run.image_count());
    summary->total_seconds = watch.seconds();
  }
  return model;
}

}  // namespace ossa::forest
