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

/// Tables derived from ForestData when a model is constructed.
struct RuntimeTables {
  std::vector<LinedTree> trees;
  std::vector<std::vector<int32_t>> vote_rows;  // tree × leaf, in the order of LinedTree; -1 where
                                                // the tree has no votes
  std::vector<FactorModel> factor_models;       // one per pose prior
  /// Per target: the two most correlated other targets; empty without pose priors.
  std::vector<std::vector<uint32_t>> neighbours;
  std::vector<LeafTables> leaves;            // one per tree, in the order of LinedTree; or none:
  std::unique_ptr<DeferredLeaves> deferred;  // last: destroyed before what it uses
};

/// For a run-only model, leaf tables are deferred, and the trees' nodes and entries are freed.
/// Precondition: no tree has more than LinedTree::kMostLeaves leaves.
RuntimeTables MakeRuntimeTables(ForestData* data, ModelUse use);

/// The rows of the leaves reached; sample × tree. The result refers to `leaf`.
LeafRows FindRows(const RuntimeTables& tables, std::span<const int32_t> leaf);

/// Adds the tables derived from pose priors: factor models and neighbours.
void AddPriorTables(const ForestData& data, RuntimeTables* tables);

/// The vote row of each leaf: rows are numbered breadth-first over the nodes at the tree's
/// vote_depth and the leaves above it. `row_count` receives their number.
std::vector<int32_t> VoteRows(const Tree& tree, size_t* row_count);

}  // namespace ossa::forest
