#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "depth/base/random.h"
#include "forest/forest.h"
#include "forest/training/images_internal.h"

namespace ossa::forest {

// Bins per candidate and label in a histogram; of cache lines
inline constexpr size_t kBinStride = 64;

/// A candidate feature: probe[first] - probe[second], binned as ((f + jitter) >> shift) + bins / 2.
struct Candidate {
  uint16_t first = 0;
  uint16_t second = 0;  // the pixel itself where it equals the number of offsets
  int16_t shift = 0;
  int16_t jitter_mm = 0;
};

/// The candidate features of one node, generated from its seed.
struct CandidateSet {
  std::vector<float> offset_u, offset_v;  // offset units; whole numbers
  std::vector<Candidate> candidates;
  int bins = 0;
};
CandidateSet DrawCandidates(const TrainOptions& options, uint64_t seed, uint64_t node_pixels);

/// Threshold for a split after `bin`: f <= threshold goes left.
int16_t ComputeThreshold(const Candidate& candidate, int bins, int bin);

/// A sample and its image.
struct SampleRef {
  const ObjectImage* image = nullptr;
  uint16_t x = 0;
  uint16_t y = 0;
};

/// Depth at every probe (rows; the last row is the pixel itself) for every sample (columns).
struct ProbeTable {
  size_t columns = 0;
  size_t row_stride = 0;
  std::vector<int16_t> depth_mm;

  const int16_t* row(size_t i) const { return depth_mm.data() + i * row_stride; }
};
void FillProbes(const CandidateSet& set, std::span<const SampleRef> samples, ProbeTable* table);

/// The columns of a probe table with one label.
struct LabelRun {
  uint32_t label = 0;  // histogram row: 0 .. labels present - 1
  uint32_t begin = 0;
  uint32_t end = 0;
};

/// Adds candidates [first, last) into histogram[(label · (last - first) + candidate - first) ·
/// kBinStride + bin].
void CountResponses(const CandidateSet& set, const ProbeTable& table,
                    std::span<const LabelRun> runs, size_t first, size_t last, uint32_t* histogram);

struct Split {
  size_t candidate = 0;
  int bin = -1;          // -1: none
  double gain_bits = 0;  // information gain per sample (Shotton 2011, eqs. 5-6)
};

/// Table of n log2 n.
class EntropyTable {
 public:
  explicit EntropyTable(size_t size);
  float operator()(uint32_t n) const { return n < table_.size() ? table_[n] : Compute(n); }

 private:
  static float Compute(uint32_t n);
  std::vector<float> table_;
};

/// The best split of candidates [first, last); of ties the first.
Split BestSplit(const uint32_t* histogram, size_t labels, size_t first, size_t last, int bins,
                const EntropyTable& entropy);

/// The node for a split of a candidate set.
Node MakeNode(const CandidateSet& set, const Split& split);

}  // namespace ossa::forest
