#include "forest/training/split_internal.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "depth/base/cpu_dispatch.h"

namespace ossa::forest {
namespace {

// Constants: chosen by hand, for speed.

constexpr size_t kTile = 32;  // samples probed per transposed tile

// Pixel indices of all probes of one sample.
OSSA_CPU_DISPATCH void ProbeIndices(const float* offset_u, const float* offset_v, size_t count,
                                    const std::array<int, 5>& place, float pixels_u, float pixels_v,
                                    int32_t* index) {
  const auto [x, y, width, height, stride] = place;
  for (size_t m = 0; m < count; ++m) {
    index[m] =
        ProbeIndex(x, y, offset_u[m], offset_v[m], pixels_u, pixels_v, width, height, stride);
  }
}

OSSA_CPU_DISPATCH void BinResponses(const int16_t* first, const int16_t* second, size_t count,
                                    const Candidate& candidate, int bins, uint16_t* bin) {
  const auto jitter = candidate.jitter_mm;
  const auto shift = candidate.shift;
  const auto half = static_cast<int16_t>(bins / 2);
  const auto top = static_cast<int16_t>(bins - 1);
  for (size_t i = 0; i < count; ++i) {
    const auto f = static_cast<int16_t>(first[i] - second[i] + jitter);
    auto b = static_cast<int16_t>(static_cast<int16_t>(f >> shift) + half);
    b = b < 0 ? int16_t{0} : b;
    b = b > top ? top : b;
    bin[i] = static_cast<uint16_t>(b);
  }
}

// Departure: small nodes evaluate fewer candidates and offsets, because their few pixels cannot
// discriminate between thousands of splits. All of them from 2000 pixels on, a quarter at 500 and
// below.
int Effective(int most, int least, uint64_t node_pixels) {
  const double share = std::clamp(static_cast<double>(node_pixels) / 2000.0, 0.25, 1.0);
  return std::clamp(static_cast<int>(most * share), std::min(least, most), most);
}

}  // namespace

CandidateSet DrawCandidates(const TrainOptions& options, uint64_t seed, uint64_t node_pixels) {
  CandidateSet set;
  Random random(seed);
  const int thresholds = node_pixels >= 2000
                             ? options.thresholds
                             : std::min(options.thresholds, static_cast<int>(8 + node_pixels / 50));
  set.bins = thresholds + 1;
  // Log-uniform lengths: near probes capture shape, far ones pose.
  constexpr double kShortest_pixel_m = 4.0;
  const double ratio = std::log(std::max(options.box_pixel_m / kShortest_pixel_m, 1.0));
  const int probes = Effective(options.offsets, 40, node_pixels);
  for (int i = 0; i < probes; ++i) {
    const double length = kShortest_pixel_m * std::exp(ratio * random.Unit());
    const double angle = 2.0 * 3.14159265358979323846 * random.Unit();
    const double scale = length * kOffsetUnitsPerPixelMetre;
    set.offset_u.push_back(static_cast<float>(std::lround(scale * std::cos(angle))));
    set.offset_v.push_back(static_cast<float>(std::lround(scale * std::sin(angle))));
  }
  const int count = Effective(options.candidates, 1, node_pixels);
  const auto offsets = static_cast<uint32_t>(probes);
  for (int i = 0; i < count; ++i) {
    Candidate candidate;
    candidate.first = static_cast<uint16_t>(random.Below(offsets));
    const bool alone = random.Below(2) == 0;
    const uint32_t other = random.Below(offsets);
    candidate.second = static_cast<uint16_t>(alone || other == candidate.first ? offsets : other);
    candidate.shift = static_cast<int16_t>(1 + random.Below(6));  // bins of 2 to 64 mm
    candidate.jitter_mm = static_cast<int16_t>(random.Below(1U << candidate.shift));
    set.candidates.push_back(candidate);
  }
  return set;
}

int16_t ComputeThreshold(const Candidate& candidate, int bins, int bin) {
  // bin(f) > bin  <=>  (f + jitter) >> shift >= bin + 1 - half  <=>  f > this.
  const int edge = (bin + 1 - bins / 2) * (1 << candidate.shift);
  return static_cast<int16_t>(edge - candidate.jitter_mm - 1);
}

void FillProbes(const CandidateSet& set, std::span<const SampleRef> samples, ProbeTable* table) {
  const size_t probes = set.offset_u.size();
  table->columns = samples.size();
  // An odd number of cache lines per row avoids cache set conflicts within columns.
  table->row_stride = ((samples.size() + 31) / 32 | 1U) * 32;
  table->depth_mm.resize((probes + 1) * table->row_stride);
  std::vector<int32_t> index(probes);
  std::vector<int16_t> tile(kTile * (probes + 1));
  for (size_t first = 0; first < samples.size(); first += kTile) {
    const size_t count = std::min(kTile, samples.size() - first);
    for (size_t s = 0; s < count; ++s) {
      const SampleRef& sample = samples[first + s];
      const ObjectImage& image = *sample.image;
      const uint16_t* depth = image.depth_mm.data();
      const uint16_t own_mm = depth[image.At(sample.x, sample.y)];
      const auto d_mm = static_cast<float>(own_mm);
      ProbeIndices(set.offset_u.data(), set.offset_v.data(), probes,
                   {sample.x, sample.y, image.width, image.height, image.stride()},
                   image.scale_u / d_mm, image.scale_v / d_mm, index.data());
      int16_t* out = tile.data() + s * (probes + 1);
      for (size_t m = 0; m < probes; ++m) out[m] = static_cast<int16_t>(depth[index[m]]);
      out[probes] = static_cast<int16_t>(own_mm);
    }
    for (size_t m = 0; m <= probes; ++m) {
      int16_t* row = table->depth_mm.data() + m * table->row_stride + first;
      for (size_t s = 0; s < count; ++s) row[s] = tile[s * (probes + 1) + m];
    }
  }
}

void CountResponses(const CandidateSet& set, const ProbeTable& table,
                    std::span<const LabelRun> runs, size_t first, size_t last,
                    uint32_t* histogram) {
  // Four candidates interleaved: their counters are far apart, so additions do not depend on one
  // another.
  constexpr size_t kTogether = 4;
  constexpr size_t kColumns = 512;
  uint16_t bin[kTogether][kColumns];
  const size_t width = last - first;
  for (size_t c = first; c < last; c += kTogether) {
    const size_t together = std::min(kTogether, last - c);
    for (const LabelRun& run : runs) {
      uint32_t* base = histogram + (run.label * width + c - first) * kBinStride;
      for (size_t begin = run.begin; begin < run.end; begin += kColumns) {
        const size_t count = std::min<size_t>(kColumns, run.end - begin);
        for (size_t k = 0; k < together; ++k) {
          const Candidate& candidate = set.candidates[c + k];
          BinResponses(table.row(candidate.first) + begin, table.row(candidate.second) + begin,
                       count, candidate, set.bins, bin[k]);
        }
        if (together == kTogether) {
          for (size_t i = 0; i < count; ++i) {
            ++base[bin[0][i]];
            ++base[kBinStride + bin[1][i]];
            ++base[2 * kBinStride + bin[2][i]];
            ++base[3 * kBinStride + bin[3][i]];
          }
        } else {
          for (size_t k = 0; k < together; ++k) {
            for (size_t i = 0; i < count; ++i) ++base[k * kBinStride + bin[k][i]];
          }
        }
      }
    }
  }
}

EntropyTable::EntropyTable(size_t size) {
  for (size_t n = 0; n < size; ++n) table_.push_back(Compute(static_cast<uint32_t>(n)));
}

float EntropyTable::Compute(uint32_t n) {
  return n == 0 ? 0.0F : static_cast<float>(n * std::log2(static_cast<double>(n)));
}

namespace {

// Pixels of one candidate on the left of the threshold and in all, by class. With n_c pixels of
// class c and N in all, the entropy of a side times its size is N log N - Σ n_c log n_c.
struct Sweep {
  std::array<uint32_t, 256> left{};
  std::array<uint32_t, 256> total{};
  uint32_t all = 0;    // N
  float whole = 0.0F;  // Σ n_c log n_c of both sides together

  // `histogram` begins with the candidate's row of the first class; rows are `stride` apart.
  void Start(const uint32_t* histogram, size_t labels, size_t stride, int bins,
             const EntropyTable& entropy) {
    all = 0;
    whole = 0.0F;
    for (size_t l = 0; l < labels; ++l) {
      const uint32_t* row = histogram + l * stride;
      uint32_t sum = 0;
      for (int b = 0; b < bins; ++b) sum += row[b];
      left[l] = 0;
      total[l] = sum;
      all += sum;
      whole += entropy(sum);
    }
  }
};

}  // namespace

Split BestSplit(const uint32_t* histogram, size_t labels, size_t first, size_t last, int bins,
                const EntropyTable& entropy) {
  Split best;
  const size_t width = last - first;
  Sweep sweep;
  for (size_t c = 0; c < width; ++c) {
    sweep.Start(histogram + c * kBinStride, labels, width * kBinStride, bins, entropy);
    const uint32_t all = sweep.all;
    if (all == 0) continue;
    const double parent = static_cast<double>(entropy(all)) - sweep.whole;
    uint32_t left_all = 0;
    float left_sum = 0.0F;  // Σ n_c log n_c on the left side
    float right_sum = sweep.whole;
    for (int b = 0; b + 1 < bins; ++b) {
      uint32_t moved = 0;
      for (size_t l = 0; l < labels; ++l) {
        const uint32_t n = histogram[(l * width + c) * kBinStride + static_cast<size_t>(b)];
        if (n == 0) continue;
        moved += n;
        const uint32_t left = sweep.left[l];
        const uint32_t right = sweep.total[l] - left;
        left_sum += entropy(left + n) - entropy(left);
        right_sum += entropy(right - n) - entropy(right);
        sweep.left[l] = left + n;
      }
      left_all += moved;
      if (moved == 0 || left_all == 0 || left_all == all) continue;
      const double children = static_cast<double>(entropy(left_all)) - left_sum +
                              static_cast<double>(entropy(all - left_all)) - right_sum;
      const double gain = (parent - children) / all;
      if (gain > best.gain_bits) best = {first + c, b, gain};
    }
  }
  return best;
}

Node MakeNode(const CandidateSet& set, const Split& split) {
  const Candidate& candidate = set.candidates[split.candidate];
  const auto offset = [&](size_t probe) -> std::array<int16_t, 2> {
    if (probe == set.offset_u.size()) return {0, 0};
    return {static_cast<int16_t>(set.offset_u[probe]), static_cast<int16_t>(set.offset_v[probe])};
  };
  Node node;
  node.u = offset(candidate.first);
  node.v = offset(candidate.second);
  node.threshold_mm = ComputeThreshold(candidate, set.bins, split.bin);
  return node;
}

}  // namespace ossa::forest
