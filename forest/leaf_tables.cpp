#include "forest/leaf_tables_internal.h"

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include "depth/base/large_pages.h"

namespace ossa::forest {
namespace {

// Constants: chosen by hand; entry weights by the format.

constexpr float kSmoothing = 3.0F;  // weight (of 127) of a leaf's classes over all contexts

constexpr size_t kCells = 512;  // distinct cells of an entry, of the format

// Context and class of each cell: avoids millions of divisions.
class CellPlaces {
 public:
  explicit CellPlaces(size_t classes) {
    for (size_t cell = 0; cell < kCells; ++cell) {
      class_[cell] = static_cast<uint16_t>(cell % classes);
      context_[cell] = static_cast<uint16_t>(cell / classes);
    }
  }
  size_t ClassOf(size_t cell) const { return class_[cell]; }
  size_t ContextOf(size_t cell) const { return context_[cell]; }

 private:
  std::array<uint16_t, kCells> class_{}, context_{};
};

// As std::lround, but inlined.
int Round(float value) {
  return static_cast<int>(static_cast<double>(value) + (value < 0.0F ? -0.5 : 0.5));
}

// A leaf's weights by context and class. Most cells are 0: Load clears only those of the previous
// leaf. Half of a model's load time is spent here and in ComputeShares: hence plain pointers,
// without assertions.
class LeafCells {
 public:
  LeafCells(const CellPlaces& places, size_t classes, size_t contexts)
      : context_weight(contexts, 0.0F),
        places_(places),
        class_weight_(classes, 0.0F),
        weight_(contexts * classes, 0.0F) {}

  void Load(const LeafEntries& tree, size_t leaf) {
    Clear();
    float *class_weight = class_weight_.data(), *cells = weight_.data();
    float total = 0.0F;
    const uint16_t* entry = tree.entries.data() + tree.begin.data()[leaf];
    const uint16_t* end = tree.entries.data() + tree.begin.data()[leaf + 1];
    for (; entry < end; ++entry) {
      const size_t cell = *entry & (kCells - 1);
      const size_t c = places_.ClassOf(cell);
      const auto weight = static_cast<float>(*entry >> 9U);
      if (class_weight[c] == 0.0F) seen_classes.push_back(c);
      cells[cell] += weight;
      class_weight[c] += weight;
      context_weight[places_.ContextOf(cell)] += weight;
      total += weight;
    }
    for (const size_t c : seen_classes) share_of_seen.push_back(class_weight[c] / total);
  }

  /// One weight per class.
  const float* Weights(size_t context) const {
    return weight_.data() + context * class_weight_.size();
  }

  std::vector<size_t> seen_classes;   // unordered
  std::vector<float> share_of_seen;   // for each of these: P(class | leaf)
  std::vector<float> context_weight;  // sums over classes

 private:
  void Clear() {
    const size_t classes = class_weight_.size(), all = weight_.size();
    float *class_weight = class_weight_.data(), *cells = weight_.data();
    for (const size_t c : seen_classes) {
      class_weight[c] = 0.0F;
      for (size_t cell = c; cell < all; cell += classes) cells[cell] = 0.0F;
    }
    std::fill(context_weight.begin(), context_weight.end(), 0.0F);
    seen_classes.clear();
    share_of_seen.clear();
  }

  const CellPlaces& places_;
  std::vector<float> class_weight_;
  std::vector<float> weight_;  // context × class
};

// log P(leaf | context) up to a constant per leaf, by the leaf's weight in the context. Weights are
// integers: a table avoids millions of logarithms.
class LogRatios {
 public:
  explicit LogRatios(const ForestData& data) {
    constexpr size_t kMostWeight = 127;  // largest weight of an entry
    for (const float prior : data.context_prior) {
      prior_.push_back(std::max(prior, 1e-3F));
      std::vector<float>& ratio = table_.emplace_back();
      for (size_t w = 0; w <= kMostWeight * data.class_names.size(); ++w) {
        ratio.push_back(Compute(static_cast<float>(w), prior_.back()));
      }
    }
  }

  float Of(float weight, size_t context) const {
    const std::vector<float>& ratio = table_.data()[context];
    if (weight < static_cast<float>(ratio.size())) return ratio.data()[static_cast<size_t>(weight)];
    return Compute(weight, prior_.data()[context]);
  }

 private:
  static float Compute(float weight, float prior) {
    constexpr float kFloor = 0.5F;  // half an entry weight: may have been rounded to 0
    return std::log((weight + kFloor * prior) / prior);
  }

  std::vector<float> prior_;
  std::vector<std::vector<float>> table_;  // context × weight
};

// Fills the evidence of a leaf, centred, so that sums stay small.
void FillEvidence(const LeafCells& cells, const LogRatios& log_ratios, int16_t* evidence) {
  const size_t contexts = cells.context_weight.size();
  const float* weight = cells.context_weight.data();
  std::array<float, kCells> ratio;  // per context
  float mean = 0.0F;
  for (size_t k = 0; k < contexts; ++k) {
    ratio[k] = log_ratios.Of(weight[k], k);
    mean += ratio[k] / static_cast<float>(contexts);
  }
  for (size_t k = 0; k < contexts; ++k) {
    evidence[k] = static_cast<int16_t>(Round(256.0F * (ratio[k] - mean)));
  }
}

// Packs a share and its column into one integer that sorts by descending share, then by ascending
// column. The bits of positive floats sort like their values.
uint64_t PackShare(float p, size_t column) {
  return uint64_t{~std::bit_cast<uint32_t>(p)} << 8U | column;
}

// P(class | leaf, context), smoothed with P(class | leaf), as the largest shares of 255.
ShareRow ComputeShares(const LeafCells& cells, size_t context) {
  std::array<uint64_t, kMostShares> most;  // ascending
  most.fill(PackShare(0.0F, 0));
  const float whole = cells.context_weight[context] + kSmoothing;
  const float *weights = cells.Weights(context), *share_of_seen = cells.share_of_seen.data();
  const size_t *seen = cells.seen_classes.data(), count = cells.seen_classes.size();
  for (size_t i = 0; i < count; ++i) {
    const size_t c = seen[i];
    const float p = (weights[c] + kSmoothing * share_of_seen[i]) / whole;
    if (p <= 0.004F) continue;
    uint64_t share = PackShare(p, c - 1);
    for (uint64_t& larger : most) {
      const uint64_t smaller = std::max(share, larger);
      larger = std::min(share, larger);
      share = smaller;
    }
  }
  ShareRow row;
  for (size_t i = 0; i < kMostShares; ++i) {
    const auto p = std::bit_cast<float>(~static_cast<uint32_t>(most[i] >> 8U));
    row.column[i] = static_cast<uint8_t>(most[i]);
    row.share[i] = static_cast<uint8_t>(Round(p * 255.0F));
  }
  return row;
}

// Fills the share rows of a leaf. All contexts without observations have a common row.
void FillShares(const LeafCells& cells, uint8_t* shares_of, ShareRow* shares) {
  constexpr int kNone = -1;
  int unseen = kNone, rows = 0;
  const size_t contexts = cells.context_weight.size();
  const float* weight = cells.context_weight.data();
  for (size_t k = 0; k < contexts; ++k) {
    const bool is_seen = weight[k] > 0.0F;
    if (!is_seen && unseen != kNone) {
      shares_of[k] = static_cast<uint8_t>(unseen);
      continue;
    }
    shares[rows] = ComputeShares(cells, k);
    if (!is_seen) unseen = rows;
    shares_of[k] = static_cast<uint8_t>(rows++);
  }
}

// Number of rows that FillShares makes for a leaf.
size_t CountShares(const LeafEntries& tree, size_t leaf, const CellPlaces& places,
                   size_t contexts) {
  std::array<uint64_t, kCells / 64> is_seen{};  // one bit per context
  const uint16_t* entries = tree.entries.data();
  for (uint32_t e = tree.begin.data()[leaf]; e < tree.begin.data()[leaf + 1]; ++e) {
    const size_t context = places.ContextOf(entries[e] & (kCells - 1));
    if (entries[e] >> 9U != 0) is_seen[context / 64] |= uint64_t{1} << (context % 64);
  }
  size_t seen = 0;
  for (const uint64_t bits : is_seen) seen += static_cast<size_t>(std::popcount(bits));
  return std::min(seen + 1, contexts);
}

}  // namespace

// Data shared by all leaves of a model.
struct LeafTableMaker::Shared {
  explicit Shared(const ForestData& data)
      : classes(data.class_names.size()),
        contexts(data.context_names.size()),
        places(classes),
        log_ratios(data) {}

  size_t classes, contexts;
  CellPlaces places;
  LogRatios log_ratios;
};

LeafTableMaker::LeafTableMaker(const ForestData& data)
    : shared_(std::make_unique<const Shared>(data)) {}

LeafTableMaker::~LeafTableMaker() = default;

LeafTables LeafTableMaker::Make(const LeafEntries& tree, std::span<const int32_t> leaves,
                                const std::atomic<bool>* stop) const {
  const size_t contexts = shared_->contexts, count = leaves.size();
  const int32_t* leaf_of = leaves.data();
  LeafTables tables;
  uint32_t rows_of_shares = 0;
  tables.first_shares = MakeLargeVector<uint32_t>(count);
  for (size_t i = 0; i < count; ++i) {
    tables.first_shares[i] = rows_of_shares;
    rows_of_shares += static_cast<uint32_t>(
        CountShares(tree, static_cast<size_t>(leaf_of[i]), shared_->places, contexts));
  }
  tables.shares = MakeLargeVector<ShareRow>(rows_of_shares);
  tables.shares_of = MakeLargeVector<uint8_t>(contexts * count);
  tables.evidence = MakeLargeVector<int16_t>(contexts * count);
  constexpr size_t kAtOnce = 4096;
  using Leaves = oneapi::tbb::blocked_range<size_t>;
  oneapi::tbb::parallel_for(Leaves(0, count, kAtOnce), [&](const Leaves& some) {
    if (stop != nullptr && stop->load(std::memory_order_relaxed)) return;
    LeafCells cells(shared_->places, shared_->classes, contexts);
    for (size_t i = some.begin(); i < some.end(); ++i) {
      cells.Load(tree, static_cast<size_t>(leaf_of[i]));
      FillEvidence(cells, shared_->log_ratios, &tables.evidence[i * contexts]);
      FillShares(cells, &tables.shares_of[i * contexts],
                 tables.shares.data() + tables.first_shares[i]);
    }
  });
  return tables;
}

}  // namespace ossa::forest
