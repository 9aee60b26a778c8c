#include "forest/gathered_leaves_internal.h"

#include <algorithm>

namespace ossa::forest {
namespace {

// Capacity as a share of a tree's leaves, one in this many: tables of a quarter take 8 MB, and a
// video of some seconds needs fewer. By hand.
constexpr size_t kShareOfLeaves = 4;

template <typename T>
void Add(const std::vector<T>& more, std::vector<T>* all) {
  all->insert(all->end(), more.begin(), more.end());
}

}  // namespace

GatheredLeaves::GatheredLeaves(size_t leaves, size_t samples)
    : room_(std::max(leaves / kShareOfLeaves, samples)), place_(leaves, -1) {}

void GatheredLeaves::Gather(const LeafTableMaker& maker, const LeafSource& source,
                            std::span<const int32_t> leaf, size_t trees, std::span<int32_t> at) {
  std::vector<int32_t> met;
  for (size_t i = 0; i < leaf.size(); i += trees) {
    int32_t& here = place_[static_cast<size_t>(leaf[i])];
    if (here < 0) {
      here = static_cast<int32_t>(count_ + met.size());
      met.push_back(source.order[static_cast<size_t>(leaf[i])]);
    }
    at[i] = here;
  }
  if (met.empty()) return;
  Append(maker.Make({source.entry_begin, source.entries}, met), met.size());
}

// Reserved memory is not allocated by the system until it is written to.
void GatheredLeaves::Append(const LeafTables& more, size_t count) {
  if (count_ == 0) {
    const size_t contexts = more.shares_of.size() / count;
    tables_.evidence.reserve(room_ * contexts);
    tables_.shares.reserve(room_ * contexts);  // at most one per leaf and context
    tables_.first_shares.reserve(room_);
    tables_.shares_of.reserve(room_ * contexts);
  }
  const auto first = static_cast<uint32_t>(tables_.shares.size());
  for (const uint32_t row : more.first_shares) tables_.first_shares.push_back(first + row);
  Add(more.evidence, &tables_.evidence);
  Add(more.shares, &tables_.shares);
  Add(more.shares_of, &tables_.shares_of);
  count_ += count;
}

}  // namespace ossa::forest
