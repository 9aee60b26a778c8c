#include "forest/runtime_tables_internal.h"

#include <algorithm>

#include "depth/base/large_pages.h"
#include "forest/each_tree_internal.h"

namespace ossa::forest {
namespace {

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
  constexpr size_t kMost = 2;  // by hand
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

// The vote row of each leaf, in the given order.
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
  const size_t trees = data->trees.size();
  RuntimeTables tables;
  tables.trees.resize(trees);
  tables.vote_rows.resize(trees);
  std::vector<LeafSource> sources(trees);
  ForEachTree(trees, [&](size_t t) {
    Tree& tree = data->trees[t];
    LinedTree lined = LayOutInLines(tree.nodes);
    tables.vote_rows[t] = MakeVoteRows(tree, lined.leaf);
    sources[t].order = std::move(lined.leaf);
    if (use == ModelUse::kRunOnly) {
      std::vector<Node>().swap(tree.nodes);
      sources[t].entry_begin = std::move(tree.entry_begin);
      sources[t].entries = std::move(tree.entries);
    }
    PreferLargePages(lined.lines.data(), lined.lines.size() * sizeof(NodeLine));
    tables.trees[t] = std::move(lined);
  });
  AddPriorTables(*data, &tables);
  auto maker = std::make_unique<const LeafTableMaker>(*data);
  if (use == ModelUse::kRunOnly) {
    tables.deferred = std::make_unique<DeferredLeaves>(std::move(maker), std::move(sources));
    return tables;
  }
  for (size_t t = 0; t < trees; ++t) {
    const Tree& tree = data->trees[t];
    tables.leaves.push_back(maker->Make({tree.entry_begin, tree.entries}, sources[t].order));
  }
  return tables;
}

LeafRows FindRows(const RuntimeTables& tables, std::span<const int32_t> leaf) {
  if (tables.deferred != nullptr) return tables.deferred->Find(leaf);
  LeafRows rows;
  for (const LeafTables& each : tables.leaves) rows.tables.push_back(each.View());
  rows.at = leaf;
  return rows;
}

}  // namespace ossa::forest
