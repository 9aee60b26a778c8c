#pragma once
#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "forest/forest.h"

namespace ossa::forest {

/// Classes stored per leaf and context: with eight instead, trees of depth 20 classify parts
/// equally well to 0.0003, and take 70 MB more.
inline constexpr size_t kMostShares = 4;  // chosen so, for speed

/// P(class | leaf, context) as the largest shares of 255, with the columns of their classes (class
/// - 1); an eighth of a cache line. Unused entries have share 0.
struct alignas(8) ShareRow {
  std::array<uint8_t, kMostShares> column{};
  std::array<uint8_t, kMostShares> share{};
};

/// A view of the leaf tables of one tree, for classification.
struct LeafView {
  const int16_t* evidence = nullptr;
  const ShareRow* shares = nullptr;
  const uint32_t* first_shares = nullptr;
  const uint8_t* shares_of = nullptr;

  const ShareRow& SharesOf(size_t leaf, size_t context, size_t contexts) const {
    return shares[first_shares[leaf] + shares_of[leaf * contexts + context]];
  }
};

/// Tables of all or some leaves of one tree, concatenated.
struct LeafTables {
  std::vector<int16_t> evidence;  // leaf × context: log P(leaf | context) - mean, 1/256 nat
  /// The rows of each leaf are consecutive: one per observed context, and one for all others. Half
  /// of a deep tree's leaves were observed in few contexts.
  std::vector<ShareRow> shares;
  std::vector<uint32_t> first_shares;  // per leaf: its first row
  std::vector<uint8_t> shares_of;      // leaf × context: row offset within the leaf

  LeafView View() const {
    return {evidence.data(), shares.data(), first_shares.data(), shares_of.data()};
  }
};

/// The entries of each leaf of one tree, as in Tree.
struct LeafEntries {
  std::span<const uint32_t> begin;
  std::span<const uint16_t> entries;
};

/// Builds leaf tables.
class LeafTableMaker {
 public:
  /// For the trees of the given model.
  explicit LeafTableMaker(const ForestData& data);
  ~LeafTableMaker();

  /// Builds the tables of these leaves, given by their numbers in Tree, in this order;
  /// multi-threaded. The result is meaningless if `stop` became true.
  LeafTables Make(const LeafEntries& tree, std::span<const int32_t> leaves,
                  const std::atomic<bool>* stop = nullptr) const;

 private:
  struct Shared;
  std::unique_ptr<const Shared> shared_;
};

}  // namespace ossa::forest
