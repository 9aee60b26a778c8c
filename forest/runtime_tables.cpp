#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "depth/base/large_pages.h"
#include "forest/runtime_tables_internal.h"

namespace ossa::forest {
namespace {

// Constants: chosen by hand; weights are the format's.

constexpr float kSmoothing = 3.0F;  // entry weights (of 127) by which a leaf's own mix of classes
                                    // stands in where a context was hardly seen

constexpr size_t kCells = 512;  // that an entry can tell, of the format

// Of each cell of context and class which they are: spares millions of divisions.
class CellPlaces {
 public:
  explicit CellPlaces(size_t classes) {
    for (size_t cell = 0; cell < kCells; ++cell) {
      class_[cell] = static_cast<uint16_t>(cell % classes);
      context_[cell] = static_cast<uint16_t>(cell / classes);
    }
  }
  size_t ClassOf(size_t cell) const { return class_[cell]; }
  size_t ContextOf(size_t cell) const { return context_[cell]; }

 private:
  std::array<uint16_t, kCells> class_{}, context_{};
};

// As std::lround, which is a call.
int Round(float value) {
  return static_cast<int>(static_cast<double>(value) + (value < 0.0F ? -0.5 : 0.5));
}

// A leaf's weights, told by context and class. Few of the cells are anything but 0: Load clears
// those of the leaf before instead of all. Half of the time that a model takes to load is spent
// here and in ComputeShares: hence the plain pointers, which no library's assertions check.
class LeafCells {
 public:
  LeafCells(const CellPlaces& places, size_t classes, size_t contexts)
      : context_weight(contexts, 0.0F),
        places_(places),
        class_weight_(classes, 0.0F),
        weight_(contexts * classes, 0.0F) {}

  void Load(const Tree& tree, size_t leaf) {
    Clear();
    float *class_weight = class_weight_.data(), *cells = weight_.data();
    float total = 0.0F;
    const uint16_t* entry = tree.entries.data() + tree.entry_begin[leaf];
    const uint16_t* end = tree.entries.data() + tree.entry_begin[leaf + 1];
    for (; entry < end; ++entry) {
      const size_t cell = *entry & (kCells - 1);
      const size_t c = places_.ClassOf(cell);
      const auto weight = static_cast<float>(*entry >> 9U);
      if (class_weight[c] == 0.0F) seen_classes.push_back(c);
      cells[cell] += weight;
      class_weight[c] += weight;
      context_weight[places_.ContextOf(cell)] += weight;
      total += weight;
    }
    for (const size_t c : seen_classes) share_of_seen.push_back(class_weight[c] / total);
  }

  /// One for each class.
  const float* Weights(size_t context) const {
    return weight_.data() + context * class_weight_.size();
  }

  std::vector<size_t> seen_classes;   // in no order
  std::vector<float> share_of_seen;   // of each of them: P(class | leaf)
  std::vector<float> context_weight;  // sums over classes

 private:
  void Clear() {
    const size_t classes = class_weight_.size(), all = weight_.size();
    float *class_weight = class_weight_.data(), *cells = weight_.data();
    for (const size_t c : seen_classes) {
      class_weight[c] = 0.0F;
      for (size_t cell = c; cell < all; cell += classes) cells[cell] = 0.0F;
    }
    std::fill(context_weight.begin(), context_weight.end(), 0.0F);
    seen_classes.clear();
    share_of_seen.clear();
  }

  const CellPlaces& places_;
  std::vector<float> class_weight_;
  std::vector<float> weight_;  // context × class
};

// log P(leaf | context) up to a constant of the leaf, by the leaf's weight in the context. Weights
// are whole numbers: a table spares millions of logarithms.
class LogRatios {
 public:
  explicit LogRatios(const ForestData& data) {
    constexpr size_t kMostWeight = 127;  // of an entry
    for (const float prior : data.context_prior) {
      prior_.push_back(std::max(prior, 1e-3F));
      std::vector<float>& ratio = table_.emplace_back();
      for (size_t w = 0; w <= kMostWeight * data.class_names.size(); ++w) {
        ratio.push_back(Compute(static_cast<float>(w), prior_.back()));
      }
    }
  }

  float Of(float weight, size_t context) const {
    const std::vector<float>& ratio = table_.data()[context];
    if (weight < static_cast<float>(ratio.size())) return ratio.data()[static_cast<size_t>(weight)];
    return Compute(weight, prior_.data()[context]);
  }

 private:
  static float Compute(float weight, float prior) {
    constexpr float kFloor = 0.5F;  // half an entry weight: what rounding may have hidden
    return std::log((weight + kFloor * prior) / prior);
  }

  std::vector<float> prior_;
  std::vector<std::vector<float>> table_;  // context × weight
};

// The rows of one leaf, centred, so that sums stay small.
void FillEvidence(const LeafCells& cells, const LogRatios& log_ratios, int16_t* evidence) {
  const size_t contexts = cells.context_weight.size();
  const float* weight = cells.context_weight.data();
  std::array<float, kCells> ratio;  // of each context
  float mean = 0.0F;
  for (size_t k = 0; k < contexts; ++k) {
    ratio[k] = log_ratios.Of(weight[k], k);
    mean += ratio[k] / static_cast<float>(contexts);
  }
  for (size_t k = 0; k < contexts; ++k) {
    evidence[k] = static_cast<int16_t>(Round(256.0F * (ratio[k] - mean)));
  }
}

// A share and its column as one number: the larger the share, the smaller; of equals the smaller
// column first. Positive floats are in order of their bits.
uint64_t PackShare(float p, size_t column) {
  return uint64_t{~std::bit_cast<uint32_t>(p)} << 8U | column;
}

// P(class | leaf, context), smoothed by P(class | leaf), as the largest shares of 255.
ShareRow ComputeShares(const LeafCells& cells, size_t context) {
  std::array<uint64_t, kMostShares> most;  // ascending
  most.fill(PackShare(0.0F, 0));
  const float whole = cells.context_weight[context] + kSmoothing;
  const float *weights = cells.Weights(context), *share_of_seen = cells.share_of_seen.data();
  const size_t *seen = cells.seen_classes.data(), count = cells.seen_classes.size();
  for (size_t i = 0; i < count; ++i) {
    const size_t c = seen[i];
    const float p = (weights[c] + kSmoothing * share_of_seen[i]) / whole;
    if (p <= 0.004F) continue;
    uint64_t share = PackShare(p, c - 1);
    for (uint64_t& larger : most) {
      const uint64_t smaller = std::max(share, larger);
      larger = std::min(share, larger);
      share = smaller;
    }
  }
  ShareRow row;
  for (size_t i = 0; i < kMostShares; ++i) {
    const auto p = std::bit_cast<float>(~static_cast<uint32_t>(most[i] >> 8U));
    row.column[i] = static_cast<uint8_t>(most[i]);
    row.share[i] = static_cast<uint8_t>(Round(p * 255.0F));
  }
  return row;
}

// The rows of one leaf. All contexts in which it was never seen have one row.
void FillShares(const LeafCells& cells, uint8_t* shares_of, ShareRow* shares) {
  constexpr int kNone = -1;
  int unseen = kNone, rows = 0;
  const size_t contexts = cells.context_weight.size();
  const float* weight = cells.context_weight.data();
  for (size_t k = 0; k < contexts; ++k) {
    const bool is_seen = weight[k] > 0.0F;
    if (!is_seen && unseen != kNone) {
      shares_of[k] = static_cast<uint8_t>(unseen);
      continue;
    }
    shares[rows] = ComputeShares(cells, k);
    if (!is_seen) unseen = rows;
    shares_of[k] = static_cast<uint8_t>(rows++);
  }
}

// How many rows FillShares makes of a leaf.
size_t CountShares(const Tree& tree, size_t leaf, const CellPlaces& places, size_t contexts) {
  std::array<uint64_t, kCells / 64> is_seen{};  // a bit a context
  const uint16_t* entries = tree.entries.data();
  for (uint32_t e = tree.entry_begin[leaf]; e < tree.entry_begin[leaf + 1]; ++e) {
    const size_t context = places.ContextOf(entries[e] & (kCells - 1));
    if (entries[e] >> 9U != 0) is_seen[context / 64] |= uint64_t{1} << (context % 64);
  }
  size_t seen = 0;
  for (const uint64_t bits : is_seen) seen += static_cast<size_t>(std::popcount(bits));
  return std::min(seen + 1, contexts);
}

// Cleared in large pages from the beginning: tables are read at random places.
template <typename T>
std::vector<T> MakeTable(size_t count) {
  std::vector<T> table;
  table.reserve(count);
  PreferLargePages(table.data(), count * sizeof(T));
  table.resize(count);
  return table;
}

// Variance of the difference of two targets' positions, summed over contexts and axes.
float LooseJoint(const ForestData& data, size_t a, size_t b) {
  float sum = 0.0F;
  for (const PosePrior& prior : data.pose_priors) {
    const size_t factors = prior.loading_m.size() / (3 * data.targets.size());
    for (size_t i = 0; i < 3 * factors; ++i) {
      const float difference =
          prior.loading_m[a * 3 * factors + i] - prior.loading_m[b * 3 * factors + i];
      sum += difference * difference;
    }
    sum += 3.0F * prior.noise_m[a] * prior.noise_m[a];
    sum += 3.0F * prior.noise_m[b] * prior.noise_m[b];
  }
  return sum;
}

std::vector<std::vector<uint32_t>> Neighbours(const ForestData& data) {
  constexpr size_t kMost = 2;
  if (data.pose_priors.empty()) return {};
  std::vector<std::vector<uint32_t>> neighbours(data.targets.size());
  for (size_t t = 0; t < data.targets.size(); ++t) {
    std::vector<std::pair<float, uint32_t>> others;
    for (size_t other = 0; other < data.targets.size(); ++other) {
      if (other == t) continue;
      others.emplace_back(LooseJoint(data, t, other), static_cast<uint32_t>(other));
    }
    std::sort(others.begin(), others.end());
    for (size_t i = 0; i < std::min(kMost, others.size()); ++i) {
      neighbours[t].push_back(others[i].second);
    }
  }
  return neighbours;
}

LeafTables MakeLeafTables(const Tree& tree, const std::vector<int32_t>& order, size_t classes,
                          size_t contexts, const LogRatios& log_ratios) {
  LeafTables leaves;
  const size_t count = tree.leaf_count();
  const CellPlaces places(classes);
  uint32_t rows_of_shares = 0;
  leaves.first_shares = MakeTable<uint32_t>(count);
  for (size_t leaf = 0; leaf < count; ++leaf) {
    leaves.first_shares[leaf] = rows_of_shares;
    rows_of_shares += static_cast<uint32_t>(
        CountShares(tree, static_cast<size_t>(order[leaf]), places, contexts));
  }
  leaves.shares = MakeTable<ShareRow>(rows_of_shares);
  leaves.shares_of = MakeTable<uint8_t>(contexts * count);
  leaves.evidence = MakeTable<int16_t>(contexts * count);
  constexpr size_t kAtOnce = 4096;
  using Leaves = oneapi::tbb::blocked_range<size_t>;
  oneapi::tbb::parallel_for(Leaves(0, count, kAtOnce), [&](const Leaves& some) {
    LeafCells cells(places, classes, contexts);
    for (size_t leaf = some.begin(); leaf < some.end(); ++leaf) {
      cells.Load(tree, static_cast<size_t>(order[leaf]));
      FillEvidence(cells, log_ratios, &leaves.evidence[leaf * contexts]);
      FillShares(cells, &leaves.shares_of[leaf * contexts],
                 leaves.shares.data() + leaves.first_shares[leaf]);
    }
  });
  return leaves;
}

// Of each leaf, in that order.
std::vector<int32_t> MakeVoteRows(const Tree& tree, const std::vector<int32_t>& order) {
  if (tree.votes.empty()) return std::vector<int32_t>(order.size(), -1);
  size_t rows = 0;
  const std::vector<int32_t> row_of = VoteRows(tree, &rows);
  std::vector<int32_t> vote_row;
  vote_row.reserve(order.size());
  for (const int32_t leaf : order) vote_row.push_back(row_of[static_cast<size_t>(leaf)]);
  return vote_row;
}

}  // namespace

std::vector<int32_t> VoteRows(const Tree& tree, size_t* row_count) {
  std::vector<int32_t> row_of_leaf(tree.leaf_count(), -1);
  std::vector<int32_t> level(tree.nodes.size(), 0);
  std::vector<int32_t> row(tree.nodes.size(), -1);
  int32_t rows = 0;
  for (size_t i = 0; i < tree.nodes.size(); ++i) {
    const Node& node = tree.nodes[i];
    if (row[i] < 0 && (node.is_leaf() || level[i] == tree.vote_depth)) row[i] = rows++;
    if (node.is_leaf()) {
      row_of_leaf[static_cast<size_t>(node.leaf())] = row[i];
      continue;
    }
    for (size_t child = static_cast<size_t>(node.left), n = 0; n < 2; ++n, ++child) {
      level[child] = level[i] + 1;
      row[child] = row[i];
    }
  }
  *row_count = static_cast<size_t>(rows);
  return row_of_leaf;
}

void AddPriorTables(const ForestData& data, RuntimeTables* tables) {
  for (const PosePrior& each : data.pose_priors) tables->factor_models.emplace_back(each);
  tables->neighbours = Neighbours(data);
}

RuntimeTables MakeRuntimeTables(ForestData* data, ModelUse use) {
  RuntimeTables tables;
  const LogRatios log_ratios(*data);
  for (Tree& tree : data->trees) {
    LinedTree lined = LayOutInLines(tree.nodes);
    std::vector<int32_t> vote_row = MakeVoteRows(tree, lined.leaf);
    if (use == ModelUse::kRunOnly) {
      std::vector<Node>().swap(tree.nodes);
      ReturnFreedMemory();  // before the tree's tables are made
    }
    tables.leaves.push_back(MakeLeafTables(tree, lined.leaf, data->class_names.size(),
                                           data->context_names.size(), log_ratios));
    tables.leaves.back().vote_row = std::move(vote_row);
    std::vector<int32_t>().swap(lined.leaf);
    if (use == ModelUse::kRunOnly) {
      std::vector<uint32_t>().swap(tree.entry_begin);
      std::vector<uint16_t>().swap(tree.entries);
    }
    PreferLargePages(lined.lines.data(), lined.lines.size() * sizeof(NodeLine));
    tables.trees.push_back(std::move(lined));
  }
  AddPriorTables(*data, &tables);
  return tables;
}

}  // namespace ossa::forest
