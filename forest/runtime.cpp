#include <sys/mman.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "forest/runtime_internal.h"

namespace ossa::forest {
namespace {

constexpr int kMaxCells = 512;      // context × class, 9 bits of an entry
constexpr float kSmoothing = 3.0F;  // entry weights (of 127) by which a leaf's own mix of classes
                                    // stands in where a context was hardly seen

struct LeafCells {
  std::array<float, kMaxCells> weight{};
  std::vector<float> class_weight;    // sum over contexts
  std::vector<float> context_weight;  // sum over classes
  float total = 0.0F;
};

LeafCells CellsOf(const Tree& tree, size_t leaf, size_t classes, size_t contexts) {
  LeafCells cells;
  cells.class_weight.assign(classes, 0.0F);
  cells.context_weight.assign(contexts, 0.0F);
  for (uint32_t i = tree.entry_begin[leaf]; i < tree.entry_begin[leaf + 1]; ++i) {
    const size_t code = tree.entries[i] & 511U;
    const auto weight = static_cast<float>(tree.entries[i] >> 9U);
    cells.weight[code] += weight;
    cells.class_weight[code % classes] += weight;
    cells.context_weight[code / classes] += weight;
    cells.total += weight;
  }
  return cells;
}

// log P(leaf | context) up to a constant of the leaf, centred, so that sums stay small.
void AppendEvidence(const LeafCells& cells, const ForestData& data, std::vector<int16_t>* out) {
  constexpr float kFloor = 0.5F;  // half an entry weight: what rounding may have hidden
  const size_t contexts = cells.context_weight.size();
  std::vector<float> log_ratio(contexts);
  float mean = 0.0F;
  for (size_t k = 0; k < contexts; ++k) {
    const float prior = std::max(data.context_prior[k], 1e-3F);
    log_ratio[k] = std::log((cells.context_weight[k] + kFloor * prior) / prior);
    mean += log_ratio[k] / static_cast<float>(contexts);
  }
  for (const float value : log_ratio) {
    out->push_back(static_cast<int16_t>(std::lround(256.0F * (value - mean))));
  }
}

// P(class | leaf, context), smoothed by P(class | leaf), as the largest shares of 255.
ShareRow SharesOf(const LeafCells& cells, size_t context) {
  const size_t classes = cells.class_weight.size();
  std::vector<std::pair<float, uint8_t>> shares;
  const float whole = cells.context_weight[context] + kSmoothing;
  for (size_t c = 1; c < classes; ++c) {
    const float prior = cells.total > 0 ? cells.class_weight[c] / cells.total : 0.0F;
    const float p = (cells.weight[context * classes + c] + kSmoothing * prior) / whole;
    if (p > 0.004F) shares.emplace_back(-p, static_cast<uint8_t>(c - 1));
  }
  std::sort(shares.begin(), shares.end());
  ShareRow row;
  for (size_t i = 0; i < std::min(kMostShares, shares.size()); ++i) {
    row.column[i] = shares[i].second;
    row.share[i] = static_cast<uint8_t>(std::lround(-shares[i].first * 255.0F));
  }
  return row;
}

// Trees and tables are read at random places; with pages of 4 kB most reads would miss the
// translation cache first. A wish: where the system refuses, all is as good but slower.
template <typename T>
void PreferLargePages(const std::vector<T>& table) {
#if defined(__linux__)
  constexpr int kCollapse = 25;  // MADV_COLLAPSE of Linux 6.1, missing in older headers
  constexpr uintptr_t kPage = uintptr_t{2} << 20U;
  const auto begin = (reinterpret_cast<uintptr_t>(table.data()) + kPage - 1) / kPage * kPage;
  const auto end = reinterpret_cast<uintptr_t>(table.data() + table.size()) / kPage * kPage;
  if (begin >= end) return;
  auto* memory = reinterpret_cast<void*>(begin);
  madvise(memory, end - begin, MADV_HUGEPAGE);
  madvise(memory, end - begin, kCollapse);
#else
  static_cast<void>(table);
#endif
}

// Variance of the difference of two targets' positions, summed over contexts and axes.
float LooseJoint(const ForestData& data, size_t a, size_t b) {
  float sum = 0.0F;
  for (const Arrangement& arrangement : data.arrangements) {
    const size_t factors = arrangement.loading_m.size() / (3 * data.targets.size());
    for (size_t i = 0; i < 3 * factors; ++i) {
      const float difference =
          arrangement.loading_m[a * 3 * factors + i] - arrangement.loading_m[b * 3 * factors + i];
      sum += difference * difference;
    }
    sum += 3.0F * arrangement.noise_m[a] * arrangement.noise_m[a];
    sum += 3.0F * arrangement.noise_m[b] * arrangement.noise_m[b];
  }
  return sum;
}

std::vector<std::vector<uint32_t>> Neighbours(const ForestData& data) {
  constexpr size_t kMost = 2;
  if (data.arrangements.empty()) return {};
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

RuntimeTables MakeRuntimeTables(const ForestData& data) {
  RuntimeTables tables;
  const size_t classes = data.class_names.size();
  const size_t contexts = data.context_names.size();
  for (const Tree& tree : data.trees) {
    LeafTables leaves;
    leaves.shares.resize(contexts * tree.leaf_count());
    leaves.evidence.reserve(contexts * tree.leaf_count());
    for (size_t leaf = 0; leaf < tree.leaf_count(); ++leaf) {
      const LeafCells cells = CellsOf(tree, leaf, classes, contexts);
      AppendEvidence(cells, data, &leaves.evidence);
      for (size_t k = 0; k < contexts; ++k) {
        leaves.shares[k * tree.leaf_count() + leaf] = SharesOf(cells, k);
      }
    }
    size_t rows = 0;
    leaves.vote_row = VoteRows(tree, &rows);
    if (tree.votes.empty()) std::fill(leaves.vote_row.begin(), leaves.vote_row.end(), -1);
    PreferLargePages(tree.nodes);
    PreferLargePages(leaves.shares);
    PreferLargePages(leaves.evidence);
    tables.leaves.push_back(std::move(leaves));
  }
  for (const Arrangement& each : data.arrangements) tables.factor_models.emplace_back(each);
  tables.neighbours = Neighbours(data);
  return tables;
}

}  // namespace ossa::forest
