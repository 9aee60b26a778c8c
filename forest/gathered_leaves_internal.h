#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "forest/leaf_tables_internal.h"

namespace ossa::forest {

/// The data from which the tables of a tree's leaves are built.
struct LeafSource {
  std::vector<int32_t> order;         // per leaf, in the order of LinedTree: its number in Tree
  std::vector<uint32_t> entry_begin;  // as in Tree
  std::vector<uint16_t> entries;
};

/// Tables of the leaves of one tree that images have reached, in order of arrival: an image adds
/// rows only for leaves that no earlier one reached. Rows are never moved and may be read while
/// others are added. Only one thread may gather at a time.
class GatheredLeaves {
 public:
  /// Allocates capacity for a share of the tree's leaves, and for an image of `samples` samples.
  GatheredLeaves(size_t leaves, size_t samples);

  bool HasRoomFor(size_t samples) const { return count_ + samples <= room_; }

  /// Every `trees`th element of `leaf` (the leaves reached by an image's samples), starting with
  /// the first, belongs to this tree; the same positions of `at` receive the row indices.
  /// Precondition: there is capacity.
  void Gather(const LeafTableMaker& maker, const LeafSource& source, std::span<const int32_t> leaf,
              size_t trees, std::span<int32_t> at);

  LeafView View() const { return tables_.View(); }
  size_t count() const { return count_; }  // of leaves

 private:
  void Append(const LeafTables& more, size_t count);

  size_t room_, count_ = 0;     // of leaves
  std::vector<int32_t> place_;  // row of each leaf; -1: none
  LeafTables tables_;
};

}  // namespace ossa::forest
