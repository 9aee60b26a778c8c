#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "forest/trees/tree.h"

namespace ossa::forest {

/// An inner node in 8 bytes: offsets in steps as signed 12 bits in the upper bits of each 16, and a
/// quarter of the threshold in the lower four bits of each. All zero: a node that always goes left.
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

/// Three levels of a tree: seven nodes, breadth-first, in one cache line. Of its eight exits, from
/// left to right, some lead to other lines and some to leaves; below a leaf at a higher level
/// padding nodes go left, and their other exits are unused.
struct alignas(64) NodeLine {
  std::array<PackedNode, 7> node;
  uint32_t lines = 0;   // index of the first child line << 8 | mask of exits to lines
  uint32_t leaves = 0;  // index of the first leaf << 8 | mask of exits to leaves
};
static_assert(sizeof(NodeLine) == 64);

/// A tree in the memory layout of walks.
struct LinedTree {
  static constexpr size_t kMostLeaves = size_t{1} << 24U;

  std::vector<NodeLine> lines;
  int first_node = 0;         // root position in the first line; levels above it are empty
  int offset_step = 1;        // offset units
  std::vector<int32_t> leaf;  // per leaf, in the order of the lines: its number in Tree
};

/// Offsets that are not multiples of a sufficiently small step are rounded; those of our own trees
/// are multiples. Preconditions: breadth-first order, as in Tree; at most kMostLeaves leaves.
LinedTree LayOutInLines(const std::vector<Node>& nodes);

}  // namespace ossa::forest
