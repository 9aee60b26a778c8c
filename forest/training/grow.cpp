#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/enumerable_thread_specific.h>
#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <numeric>

#include "depth/base/error.h"
#include "depth/base/stopwatch.h"
#include "depth/base/train_interrupted.h"
#include "forest/training/grow_internal.h"

namespace ossa::forest {
namespace {

// Constants: chosen by hand, for speed.

constexpr size_t kBlock = 64;       // candidates per histogram block
constexpr int kContextLevels = 12;  // deeper nodes split for the class only

// The child that a sample goes to.
int32_t Child(const Node& node, const ObjectImage& image, const PixelSample& sample) {
  const uint16_t* depth = image.depth_mm.data();
  const auto d_mm = static_cast<float>(depth[image.At(sample.x, sample.y)]);
  const auto read = [&](const std::array<int16_t, 2>& offset) {
    return static_cast<int>(depth[static_cast<size_t>(
        ProbeIndex(sample.x, sample.y, offset[0], offset[1], image.scale_u / d_mm,
                   image.scale_v / d_mm, image.width, image.height, image.stride()))]);
  };
  return node.left + (read(node.u) - read(node.v) > node.threshold_mm ? 1 : 0);
}

uint64_t SampleHash(uint64_t seed, size_t image, uint32_t sample) {
  return Random(seed ^ (static_cast<uint64_t>(image) << 20U) ^ sample).Bits() >> 32U;
}

}  // namespace

TreeGrower::TreeGrower(const ImageParts& parts, const TrainOptions& options, const Reducer& reducer,
                       size_t class_count, size_t context_count, int tree_number)
    : parts_(parts),
      options_(options),
      reducer_(reducer),
      class_count_(class_count),
      context_count_(context_count),
      tree_number_(tree_number),
      samples_(parts.part_count()),
      entropy_(static_cast<size_t>(options.node_pixels) * 2 + 1) {
  DrawSamples();
}

// Each tree uses its own subset of the pixels drawn from an image.
void TreeGrower::DrawSamples() {
  const int drawn = std::max(options_.pixels, options_.refill_pixels);
  const auto keep_below = static_cast<uint64_t>(static_cast<double>(options_.pixels) / drawn *
                                                static_cast<double>(uint64_t{1} << 32U));
  const uint64_t seed = MixSeed(options_.seed, 0xd4a, static_cast<uint64_t>(tree_number_));
  parts_.Visit([&](size_t part, const std::vector<StoredImage>& images) {
    for (uint32_t i = 0; i < images.size(); ++i) {
      for (uint32_t s = 0; s < images[i].samples.size(); ++s) {
        if (SampleHash(seed, images[i].index, s) < keep_below) {
          samples_[part].samples.push_back({i, s, 0});
        }
      }
    }
    sample_count_ += samples_[part].samples.size();
  });
}

void TreeGrower::Place(const GrowingTree& tree) {
  parts_.Visit([&](size_t p, const std::vector<StoredImage>& images) {
    std::vector<Sample>& samples = samples_[p].samples;
    oneapi::tbb::parallel_for(oneapi::tbb::blocked_range<size_t>(0, samples.size()),
                              [&](const auto& range) {
                                for (size_t i = range.begin(); i < range.end(); ++i) {
                                  const StoredImage& image = images[samples[i].image];
                                  int32_t node = 0;
                                  while (tree.nodes[static_cast<size_t>(node)].left > 0) {
                                    node = Child(tree.nodes[static_cast<size_t>(node)], image.image,
                                                 image.samples[samples[i].sample]);
                                  }
                                  samples[i].node = node;
                                }
                              });
  });
  CountFrontier(tree);
}

// Moves the samples of split nodes to their children.
void TreeGrower::Route(const GrowingTree& tree) {
  parts_.Visit([&](size_t p, const std::vector<StoredImage>& images) {
    Part& part = samples_[p];
    oneapi::tbb::parallel_for(
        oneapi::tbb::blocked_range<size_t>(0, part.order.size()), [&](const auto& range) {
          for (size_t i = range.begin(); i < range.end(); ++i) {
            Sample& sample = part.samples[part.order[i]];
            const Node& node = tree.nodes[static_cast<size_t>(sample.node)];
            if (node.left < 0) continue;
            const StoredImage& image = images[sample.image];
            sample.node = Child(node, image.image, image.samples[sample.sample]);
          }
        });
  });
  CountFrontier(tree);
}

void TreeGrower::CountFrontier(const GrowingTree& tree) {
  const size_t frontier = tree.nodes.size() - tree.frontier_begin;
  frontier_counts_.assign(frontier * class_count_, 0);
  parts_.Visit([&](size_t p, const std::vector<StoredImage>& images) {
    for (const Sample& sample : samples_[p].samples) {
      const auto node = static_cast<size_t>(sample.node);
      if (node < tree.frontier_begin) continue;
      const uint8_t label = images[sample.image].samples[sample.sample].label;
      ++frontier_counts_[(node - tree.frontier_begin) * class_count_ + label];
    }
  });
  reducer_.Sum(std::span<uint32_t>(frontier_counts_));
}

void TreeGrower::SortSamples(const GrowingTree& tree) {
  const size_t frontier = tree.nodes.size() - tree.frontier_begin;
  for (Part& part : samples_) {
    part.begin.assign(frontier + 1, 0);
    for (const Sample& sample : part.samples) {
      const auto node = static_cast<size_t>(sample.node);
      if (node >= tree.frontier_begin) ++part.begin[node - tree.frontier_begin + 1];
    }
    std::partial_sum(part.begin.begin(), part.begin.end(), part.begin.begin());
    part.order.resize(part.begin.back());
    std::vector<size_t> next(part.begin.begin(), part.begin.end() - 1);
    for (uint32_t i = 0; i < part.samples.size(); ++i) {
      const auto node = static_cast<size_t>(part.samples[i].node);
      if (node >= tree.frontier_begin) part.order[next[node - tree.frontier_begin]++] = i;
    }
  }
}

// Nothing where too few pixels or only one class are left to split.
std::optional<TreeGrower::Task> TreeGrower::MakeTask(const GrowingTree& tree, size_t node,
                                                     bool by_context) const {
  const uint32_t* counts = frontier_counts_.data() + (node - tree.frontier_begin) * class_count_;
  Task task;
  task.node = node;
  task.pixels = std::accumulate(counts, counts + class_count_, uint64_t{0});
  if (task.pixels < static_cast<uint64_t>(options_.min_node_pixels)) return std::nullopt;
  const auto absent = static_cast<size_t>(std::count(counts, counts + class_count_, 0U));
  if (!by_context && class_count_ - absent < 2) return std::nullopt;
  task.by_context = by_context;
  const size_t labels = by_context ? context_count_ : class_count_;
  for (size_t l = 0; l < labels; ++l) {
    const bool used = by_context || counts[l] > 0;
    task.histogram_row.push_back(used ? static_cast<int32_t>(task.rows++) : -1);
  }
  return task;
}

std::vector<TreeGrower::Task> TreeGrower::MakeTasks(const GrowingTree& tree) const {
  std::vector<Task> tasks;
  for (size_t node = tree.frontier_begin; node < tree.nodes.size(); ++node) {
    Random random(MixSeed(options_.seed, 0xc0, static_cast<uint64_t>(tree_number_), node));
    const bool by_context =
        context_count_ > 1 && tree.level < kContextLevels && random.Unit() < options_.context_share;
    if (std::optional<Task> task = MakeTask(tree, node, by_context)) {
      tasks.push_back(std::move(*task));
    }
  }
  return tasks;
}

// Collects the node's samples in one part, subsampled to node_pixels over all parts and ranks,
// grouped by label.
void TreeGrower::Collect(const Task& task, const GrowingTree& tree, const Part& part,
                         const std::vector<StoredImage>& images, std::vector<SampleRef>* refs,
                         std::vector<LabelRun>* runs) const {
  const size_t f = task.node - tree.frontier_begin;
  const double share = static_cast<double>(options_.node_pixels) / static_cast<double>(task.pixels);
  const auto keep_below =
      static_cast<uint64_t>(std::min(share, 1.0) * static_cast<double>(uint64_t{1} << 32U));
  const uint64_t seed = MixSeed(options_.seed, 0x7417, static_cast<uint64_t>(tree_number_));
  std::vector<std::vector<SampleRef>> by_row(task.rows);
  for (size_t i = part.begin[f]; i < part.begin[f + 1]; ++i) {
    const Sample& sample = part.samples[part.order[i]];
    const StoredImage& image = images[sample.image];
    if (share < 1.0 && SampleHash(seed, image.index, sample.sample) >= keep_below) continue;
    const PixelSample& pixel = image.samples[sample.sample];
    const size_t label = task.by_context ? image.context : pixel.label;
    by_row[static_cast<size_t>(task.histogram_row[label])].push_back(
        {&image.image, pixel.x, pixel.y});
  }
  refs->clear();
  runs->clear();
  for (uint32_t row = 0; row < by_row.size(); ++row) {
    if (by_row[row].empty()) continue;
    const auto begin = static_cast<uint32_t>(refs->size());
    refs->insert(refs->end(), by_row[row].begin(), by_row[row].end());
    runs->push_back({row, begin, static_cast<uint32_t>(refs->size())});
  }
}

// All images are in memory: nodes are processed independently, with histogram blocks that fit the
// cache.
void TreeGrower::SplitInMemory(const GrowingTree& tree, std::vector<Task>* tasks) {
  struct Scratch {
    std::vector<SampleRef> refs;
    std::vector<LabelRun> runs;
    ProbeTable probes;
    std::vector<uint32_t> histogram;
  };
  oneapi::tbb::enumerable_thread_specific<Scratch> scratches;
  std::atomic<uint64_t> evaluations{0};
  parts_.Visit([&](size_t p, const std::vector<StoredImage>& images) {
    oneapi::tbb::parallel_for(size_t{0}, tasks->size(), [&](size_t i) {
      if (StopWanted()) return;
      Task& task = (*tasks)[i];
      Scratch& scratch = scratches.local();
      Collect(task, tree, samples_[p], images, &scratch.refs, &scratch.runs);
      const uint64_t seed =
          MixSeed(options_.seed, 0x5e1, static_cast<uint64_t>(tree_number_), task.node);
      task.set = DrawCandidates(options_, seed, task.pixels);
      FillProbes(task.set, scratch.refs, &scratch.probes);
      const size_t candidates = task.set.candidates.size();
      Split best;
      for (size_t first = 0; first < candidates; first += kBlock) {
        const size_t last = std::min(candidates, first + kBlock);
        scratch.histogram.assign(task.rows * (last - first) * kBinStride, 0);
        CountResponses(task.set, scratch.probes, scratch.runs, first, last,
                       scratch.histogram.data());
        const Split split =
            BestSplit(scratch.histogram.data(), task.rows, first, last, task.set.bins, entropy_);
        if (split.gain_bits > best.gain_bits) best = split;
      }
      ApplySplit(best, &task);
      evaluations += scratch.refs.size() * candidates;
    });
  });
  evaluations_ += evaluations;
}

// Images in parts or on several ranks: complete histograms of a group of nodes are accumulated part
// by part, summed over the ranks, then searched. Integer sums give the same splits.
void TreeGrower::SplitInParts(const GrowingTree& tree, std::vector<Task>* tasks) {
  const uint64_t budget = std::max<uint64_t>(options_.memory_bytes / 4, uint64_t{64} << 20U);
  size_t first = 0;
  while (first < tasks->size()) {
    if (StopWanted()) return;
    uint64_t bytes = 0;
    size_t last = first;
    while (last < tasks->size()) {
      Task& task = (*tasks)[last];
      const uint64_t seed =
          MixSeed(options_.seed, 0x5e1, static_cast<uint64_t>(tree_number_), task.node);
      task.set = DrawCandidates(options_, seed, task.pixels);
      const uint64_t size = task.rows * task.set.candidates.size() * kBinStride * sizeof(uint32_t);
      if (last > first && bytes + size > budget) break;
      bytes += size;
      ++last;
    }
    SplitGroup(tree, std::span(*tasks).subspan(first, last - first));
    first = last;
  }
}

void TreeGrower::SplitGroup(const GrowingTree& tree, std::span<Task> group) {
  std::vector<std::vector<uint32_t>> histogram(group.size());
  for (size_t i = 0; i < group.size(); ++i) {
    histogram[i].assign(group[i].rows * group[i].set.candidates.size() * kBinStride, 0);
  }
  std::atomic<uint64_t> evaluations{0};
  parts_.Visit([&](size_t p, const std::vector<StoredImage>& images) {
    oneapi::tbb::parallel_for(size_t{0}, group.size(), [&](size_t i) {
      std::vector<SampleRef> refs;
      std::vector<LabelRun> runs;
      Collect(group[i], tree, samples_[p], images, &refs, &runs);
      ProbeTable probes;
      FillProbes(group[i].set, refs, &probes);
      const size_t candidates = group[i].set.candidates.size();
      CountResponses(group[i].set, probes, runs, 0, candidates, histogram[i].data());
      evaluations += refs.size() * candidates;
    });
  });
  evaluations_ += evaluations;
  for (auto& counts : histogram) reducer_.Sum(std::span<uint32_t>(counts));
  oneapi::tbb::parallel_for(size_t{0}, group.size(), [&](size_t i) {
    const size_t candidates = group[i].set.candidates.size();
    ApplySplit(
        BestSplit(histogram[i].data(), group[i].rows, 0, candidates, group[i].set.bins, entropy_),
        &group[i]);
  });
}

void TreeGrower::ApplySplit(const Split& split, Task* task) {
  task->split = split;
  if (split.bin >= 0) task->made = MakeNode(task->set, split);
  task->set = {};
}

bool TreeGrower::Gains(const Task& task) const {
  return task.split.bin >= 0 && task.split.gain_bits >= options_.min_gain_bits;
}

void TreeGrower::SplitTasks(const GrowingTree& tree, std::vector<Task>* tasks) {
  const bool in_memory = parts_.part_count() <= 1 && reducer_.size() == 1;
  (this->*(in_memory ? &TreeGrower::SplitInMemory : &TreeGrower::SplitInParts))(tree, tasks);
  if (StopWanted()) throw TrainInterrupted("interrupted");
}

// A node whose split by context gains nothing, because no feature or every node above tells the
// contexts, is split by class instead: it may hold most of all pixels and must not become a leaf.
void TreeGrower::RetryByClass(const GrowingTree& tree, std::vector<Task>* tasks) {
  std::vector<Task> by_class;
  std::vector<Task*> failed;
  for (Task& task : *tasks) {
    if (!task.by_context || Gains(task)) continue;
    if (std::optional<Task> other = MakeTask(tree, task.node, false)) {
      by_class.push_back(std::move(*other));
      failed.push_back(&task);
    }
  }
  if (by_class.empty()) return;
  SplitTasks(tree, &by_class);
  for (size_t i = 0; i < failed.size(); ++i) *failed[i] = std::move(by_class[i]);
}

LevelReport TreeGrower::GrowLevel(GrowingTree* tree) {
  const Stopwatch watch;
  const uint64_t evaluations_before = evaluations_;
  SortSamples(*tree);
  std::vector<Task> tasks = MakeTasks(*tree);
  SplitTasks(*tree, &tasks);
  RetryByClass(*tree, &tasks);
  LevelReport report;
  report.frontier = tasks.size();
  double weighted_gain = 0.0;
  uint64_t pixels = 0;
  const size_t old_size = tree->nodes.size();
  for (const Task& task : tasks) {
    pixels += task.pixels;
    weighted_gain += task.split.gain_bits * static_cast<double>(task.pixels);
    if (!Gains(task)) continue;
    Node node = task.made;
    node.left = static_cast<int32_t>(tree->nodes.size());
    tree->nodes[task.node] = node;
    tree->nodes.resize(tree->nodes.size() + 2);
    ++report.nodes_split;
  }
  tree->frontier_begin = old_size;
  ++tree->level;
  Route(*tree);
  report.mean_gain_bits = pixels > 0 ? weighted_gain / static_cast<double>(pixels) : 0.0;
  report.evaluations = evaluations_ - evaluations_before;
  report.seconds = watch.seconds();
  return report;
}

}  // namespace ossa::forest
