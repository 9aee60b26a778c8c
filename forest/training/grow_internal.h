#pragma once
#include <functional>
#include <optional>
#include <vector>

#include "forest/training/images_internal.h"
#include "forest/training/split_internal.h"

namespace ossa::forest {

/// A tree being grown breadth-first. Nodes [frontier_begin, nodes.size()) may still be split; a
/// node not split is a leaf (left = -1 until leaves are numbered).
struct GrowingTree {
  std::vector<Node> nodes = {Node{}};
  size_t frontier_begin = 0;
  int level = 0;
};

/// Result of growing one level.
struct LevelReport {
  size_t nodes_split = 0;
  size_t frontier = 0;
  double mean_gain_bits = 0.0;
  uint64_t evaluations = 0;
  double seconds = 0.0;
};

/// Grows one tree level by level on this rank's images, synchronously with the other ranks.
class TreeGrower {
 public:
  TreeGrower(const ImageParts& parts, const TrainOptions& options, const Reducer& reducer,
             size_t class_count, size_t context_count, int tree_number);

  /// Assigns every sample to its node of `tree`; call it before the first GrowLevel.
  void Place(const GrowingTree& tree);
  /// Splits the frontier; its children become the new frontier.
  LevelReport GrowLevel(GrowingTree* tree);
  uint64_t sample_count() const { return sample_count_; }

 private:
  struct Sample {
    uint32_t image = 0;  // index within its part
    uint32_t sample = 0;
    int32_t node = 0;
  };
  struct Part {
    std::vector<Sample> samples;
    std::vector<uint32_t> order;  // samples of the frontier, grouped by node
    std::vector<size_t> begin;    // start of each frontier node in `order`, and the end
  };
  // A frontier node to split.
  struct Task {
    size_t node = 0;
    uint64_t pixels = 0;  // sum over all ranks
    bool by_context = false;
    std::vector<int32_t> histogram_row;  // per label; -1: not present
    size_t rows = 0;
    CandidateSet set;  // freed after the search
    Split split;
    Node made;  // the resulting split node
  };

  void DrawSamples();
  void SortSamples(const GrowingTree& tree);
  void CountFrontier(const GrowingTree& tree);
  std::optional<Task> MakeTask(const GrowingTree& tree, size_t node, bool by_context) const;
  std::vector<Task> MakeTasks(const GrowingTree& tree) const;
  void Collect(const Task& task, const GrowingTree& tree, const Part& part,
               const std::vector<StoredImage>& images, std::vector<SampleRef>* refs,
               std::vector<LabelRun>* runs) const;
  void SplitInMemory(const GrowingTree& tree, std::vector<Task>* tasks);
  void SplitInParts(const GrowingTree& tree, std::vector<Task>* tasks);
  void SplitGroup(const GrowingTree& tree, std::span<Task> group);
  void SplitTasks(const GrowingTree& tree, std::vector<Task>* tasks);
  void RetryByClass(const GrowingTree& tree, std::vector<Task>* tasks);
  bool Gains(const Task& task) const;
  static void ApplySplit(const Split& split, Task* task);
  void Route(const GrowingTree& tree);
  bool StopWanted() const { return options_.stop && options_.stop(); }

  const ImageParts& parts_;
  const TrainOptions& options_;
  const Reducer& reducer_;
  size_t class_count_;
  size_t context_count_;
  int tree_number_;
  std::vector<Part> samples_;
  std::vector<uint32_t> frontier_counts_;  // frontier node × class, all ranks
  EntropyTable entropy_;
  uint64_t sample_count_ = 0;
  uint64_t evaluations_ = 0;
};

}  // namespace ossa::forest
