#pragma once
#include <cstdint>
#include <vector>

#include "forest/forest.h"

namespace ossa::forest {

/// A class and its share (of 255) of a leaf's distribution in one context.
struct ClassShare {
  uint8_t class_index = 0;
  uint8_t share = 0;
};

/// One tree's leaves as classification wants them.
struct LeafTables {
  std::vector<int16_t> evidence;      // leaf × context: log P(leaf | context) - mean, 1/256 nat
  std::vector<uint32_t> share_begin;  // leaf × context (+ 1): into shares
  std::vector<ClassShare> shares;
  std::vector<int32_t> vote_row;  // of each leaf; -1 where the tree has no votes
};

/// Derived from ForestData when a model is made.
struct RuntimeTables {
  std::vector<LeafTables> leaves;  // one a tree
  /// Of each target, the two others that move with it most; empty without arrangements.
  std::vector<std::vector<uint32_t>> neighbours;
};

RuntimeTables MakeRuntimeTables(const ForestData& data);

/// The row of votes of each leaf: rows are given out breadth-first to the nodes at the tree's
/// vote_depth and to the leaves above it. `row_count` receives their number.
std::vector<int32_t> VoteRows(const Tree& tree, size_t* row_count);

}  // namespace ossa::forest
