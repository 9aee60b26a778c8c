#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "forest/trees/tree.h"

namespace ossa::forest {

/// An inner node in 8 bytes: offsets in steps, 12 bits with a sign, in the upper bits of 16, and in
/// the lower four of each a piece of the threshold. All zero: a node that goes left.
struct PackedNode {
  std::array<uint16_t, 4> word{};  // u, v

  int offset(size_t k) const { return static_cast<int16_t>(word[k]) >> 4; }
  int threshold_mm() const {
    return static_cast<int16_t>((word[0] & 15) | (word[2] & 15) << 4 | (word[1] & 15) << 8 |
                                (word[3] & 15) << 12);
  }
};
// Constants: of cache lines and of a packed node's bits.

inline constexpr int kMostPackedOffset = 2047;

inline constexpr size_t kLevelsOfLine = 3;
inline constexpr uint32_t kExitsOfLine = 8;

/// Three levels of a tree: seven nodes, breadth-first, a line of the cache. Of the eight ways out
/// of it, from left to right, some lead to other lines and some to leaves; below a leaf that ends
/// sooner nodes go left, and the other ways lead nowhere.
struct alignas(64) NodeLine {
  std::array<PackedNode, 7> node;
  uint32_t lines = 0;   // number of the first line below << 8 | which ways lead to lines
  uint32_t leaves = 0;  // of the first leaf << 8 | which ways lead to leaves
};
static_assert(sizeof(NodeLine) == 64);

/// A tree as walks want it.
struct LinedTree {
  static constexpr size_t kMostLeaves = size_t{1} << 24U;

  std::vector<NodeLine> lines;
  int first_node = 0;         // in the first line; the levels above it are empty
  int offset_step = 1;        // offset units
  std::vector<int32_t> leaf;  // of each leaf, in the order of the lines: its number in Tree
};

/// Offsets that are no multiples of a step small enough are rounded; those of our own trees are.
/// Preconditions: breadth-first order, as in Tree; at most kMostLeaves leaves.
LinedTree LayOutInLines(const std::vector<Node>& nodes);

}  // namespace ossa::forest
