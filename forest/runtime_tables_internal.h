#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "forest/factor_model_internal.h"
#include "forest/forest.h"
#include "forest/trees/node_lines_internal.h"

namespace ossa::forest {

/// Classes kept a leaf and context: trees of depth 20 with eight instead tell parts as well to
/// 0.0003, and take 70 MB more.
inline constexpr size_t kMostShares = 4;  // chosen so, for speed

/// P(class | leaf, context) as the largest shares of 255, in the class's columns (class - 1); an
/// eighth of a cache line. Unused entries have share 0.
struct alignas(8) ShareRow {
  std::array<uint8_t, kMostShares> column{};
  std::array<uint8_t, kMostShares> share{};
};

/// One tree's leaves as classification wants them, in the order of LinedTree.
struct LeafTables {
  std::vector<int16_t> evidence;  // leaf × context: log P(leaf | context) - mean, 1/256 nat
  /// Each leaf's rows one behind the other: one a context in which it was seen, and one for all
  /// others. Half of a deep tree's leaves were seen in few.
  std::vector<ShareRow> shares;
  std::vector<uint32_t> first_shares;  // of each leaf: its first row
  std::vector<uint8_t> shares_of;      // leaf × context: which of the leaf's rows
  std::vector<int32_t> vote_row;       // of each leaf; -1 where the tree has no votes

  const ShareRow& SharesOf(size_t leaf, size_t context, size_t contexts) const {
    return shares.data()[first_shares.data()[leaf] + shares_of.data()[leaf * contexts + context]];
  }

  size_t leaf_count() const { return vote_row.size(); }
};

/// Derived from ForestData when a model is made.
struct RuntimeTables {
  std::vector<LinedTree> trees;
  std::vector<LeafTables> leaves;          // one a tree
  std::vector<FactorModel> factor_models;  // one a pose prior
  /// Of each target, the two others that move with it most; empty without pose priors.
  std::vector<std::vector<uint32_t>> neighbours;
};

/// Of a model that is only run, each tree's nodes and entries are let go before the next tree's
/// turn. Precondition: no tree has more than LinedTree::kMostLeaves leaves.
RuntimeTables MakeRuntimeTables(ForestData* data, ModelUse use);

/// What follows from the pose priors: factor models and neighbours.
void AddPriorTables(const ForestData& data, RuntimeTables* tables);

/// The row of votes of each leaf: rows are given out breadth-first to the nodes at the tree's
/// vote_depth and to the leaves above it. `row_count` receives their number.
std::vector<int32_t> VoteRows(const Tree& tree, size_t* row_count);

}  // namespace ossa::forest
