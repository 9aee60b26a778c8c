#pragma once
#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "forest/forest.h"

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

/// Tables of leaves of one tree, as classification reads them; they belong to somebody else.
struct LeafView {
  const int16_t* evidence = nullptr;
  const ShareRow* shares = nullptr;
  const uint32_t* first_shares = nullptr;
  const uint8_t* shares_of = nullptr;

  const ShareRow& SharesOf(size_t leaf, size_t context, size_t contexts) const {
    return shares[first_shares[leaf] + shares_of[leaf * contexts + context]];
  }
};

/// Of one tree's leaves, or of some of them, one after another.
struct LeafTables {
  std::vector<int16_t> evidence;  // leaf × context: log P(leaf | context) - mean, 1/256 nat
  /// Each leaf's rows one behind the other: one a context in which it was seen, and one for all
  /// others. Half of a deep tree's leaves were seen in few.
  std::vector<ShareRow> shares;
  std::vector<uint32_t> first_shares;  // of each leaf: its first row
  std::vector<uint8_t> shares_of;      // leaf × context: which of the leaf's rows

  LeafView View() const {
    return {evidence.data(), shares.data(), first_shares.data(), shares_of.data()};
  }
};

/// Of each leaf of one tree what it holds, as in Tree.
struct LeafEntries {
  std::span<const uint32_t> begin;
  std::span<const uint16_t> entries;
};

/// Makes the tables of leaves.
class LeafTableMaker {
 public:
  /// For the trees of this model.
  explicit LeafTableMaker(const ForestData& data);
  ~LeafTableMaker();

  /// Of these leaves, by their numbers in Tree, in this order; on several threads. What comes back
  /// after `stop` became true is of no use.
  LeafTables Make(const LeafEntries& tree, std::span<const int32_t> leaves,
                  const std::atomic<bool>* stop = nullptr) const;

 private:
  struct Shared;
  std::unique_ptr<const Shared> shared_;
};

}  // namespace ossa::forest
