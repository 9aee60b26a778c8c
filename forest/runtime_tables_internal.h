#pragma once
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "forest/deferred_leaves_internal.h"
#include "forest/factor_model_internal.h"
#include "forest/forest.h"
#include "forest/leaf_tables_internal.h"
#include "forest/trees/node_lines_internal.h"

namespace ossa::forest {

/// Derived from ForestData when a model is made.
struct RuntimeTables {
  std::vector<LinedTree> trees;
  std::vector<std::vector<int32_t>> vote_rows;  // tree × leaf, in the order of LinedTree; -1 where
                                                // the tree has no votes
  std::vector<FactorModel> factor_models;       // one a pose prior
  /// Of each target, the two others that move with it most; empty without pose priors.
  std::vector<std::vector<uint32_t>> neighbours;
  std::vector<LeafTables> leaves;            // one a tree, in the order of LinedTree; or none:
  std::unique_ptr<DeferredLeaves> deferred;  // stops before what stands above goes
};

/// Of a model that is only run, the tables of leaves are deferred, and the trees' nodes and entries
/// are let go. Precondition: no tree has more than LinedTree::kMostLeaves leaves.
RuntimeTables MakeRuntimeTables(ForestData* data, ModelUse use);

/// The rows of leaves where walks ended; sample × tree. What comes back reads `leaf`.
LeafRows FindRows(const RuntimeTables& tables, std::span<const int32_t> leaf);

/// What follows from the pose priors: factor models and neighbours.
void AddPriorTables(const ForestData& data, RuntimeTables* tables);

/// The row of votes of each leaf: rows are given out breadth-first to the nodes at the tree's
/// vote_depth and to the leaves above it. `row_count` receives their number.
std::vector<int32_t> VoteRows(const Tree& tree, size_t* row_count);

}  // namespace ossa::forest
