#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "forest/leaf_tables_internal.h"

namespace ossa::forest {

/// What the tables of one tree's leaves are made of.
struct LeafSource {
  std::vector<int32_t> order;         // of each leaf, in the order of LinedTree: its number in Tree
  std::vector<uint32_t> entry_begin;  // as in Tree
  std::vector<uint16_t> entries;
};

/// Tables of those leaves of one tree that images met, in the order in which they did: an image
/// makes rows for leaves alone that none before it met. Rows stay where they are, and may be read
/// while more are gathered. One thread gathers at a time.
class GatheredLeaves {
 public:
  /// With room for a share of the tree's leaves, and for an image of so many samples.
  GatheredLeaves(size_t leaves, size_t samples);

  bool HasRoomFor(size_t samples) const { return count_ + samples <= room_; }

  /// Of `leaf`, where an image's samples ended, every `trees`th from the first on is one of this
  /// tree; the same place of `at` receives where its rows are. Precondition: there is room.
  void Gather(const LeafTableMaker& maker, const LeafSource& source, std::span<const int32_t> leaf,
              size_t trees, std::span<int32_t> at);

  LeafView View() const { return tables_.View(); }
  size_t count() const { return count_; }  // of leaves

 private:
  void Append(const LeafTables& more, size_t count);

  size_t room_, count_ = 0;     // of leaves
  std::vector<int32_t> place_;  // of each leaf; -1: it has none
  LeafTables tables_;
};

}  // namespace ossa::forest
