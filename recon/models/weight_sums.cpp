// Sums of whole numbers are the same in any order: what runs on eight units side by side says, bit
// for bit, what one by one says.
//
// Weights come from afar, and memory is the slowest here. Read one line after the other, those of
// inputs of nought too, they come three times as fast as with lines left out: then the processor
// sees no stream that it could fetch ahead, and fetching them ahead by hand makes up for nothing.
#include "recon/models/weight_sums_internal.h"

#include <algorithm>
#include <bit>

#include "depth/base/cpu_dispatch.h"

#if defined(__x86_64__)
#include <immintrin.h>
#endif

namespace ossa::recon {
namespace {

#if defined(__x86_64__)
// Registers hold the sums of a block's units while all pairs go by. Weights are widened once for
// all columns.
template <size_t kColumns>
__attribute__((target("avx2"))) void EightByEight(const WeightSums<kColumns>& of) {
  constexpr size_t kLanes = 8;  // of an AVX2 register
  constexpr size_t kGroups = WeightLine::kUnits / kLanes;
  const WeightLine* line = of.lines;
  for (size_t block = 0; block < of.blocks; ++block) {
    __m256i sum[kColumns][kGroups] = {};
    for (const PairFactors<kColumns>& pair : of.factors) {
      __m256i factors[kColumns];
      for (size_t c = 0; c < kColumns; ++c) {
        factors[c] = _mm256_set1_epi32(std::bit_cast<int32_t>(pair[c]));
      }
      const auto* const bytes = reinterpret_cast<const __m128i*>(line++);
      for (size_t group = 0; group < kGroups; ++group) {
        const __m256i weights = _mm256_cvtepi8_epi16(_mm_load_si128(bytes + group));
        for (size_t c = 0; c < kColumns; ++c) {
          sum[c][group] = _mm256_add_epi32(sum[c][group], _mm256_madd_epi16(weights, factors[c]));
        }
      }
    }
    for (size_t c = 0; c < kColumns; ++c) {
      auto* const sums = reinterpret_cast<__m256i*>(of.sums[c] + block * WeightLine::kUnits);
      for (size_t group = 0; group < kGroups; ++group) {
        _mm256_storeu_si256(sums + group, sum[c][group]);
      }
    }
  }
}
#endif

}  // namespace

template <size_t kColumns>
void AddWeightsOneByOne(const WeightSums<kColumns>& of) {
  const WeightLine* line = of.lines;
  for (size_t block = 0; block < of.blocks; ++block) {
    for (int32_t* const sums : of.sums) {
      std::fill_n(sums + block * WeightLine::kUnits, WeightLine::kUnits, 0);
    }
    for (const PairFactors<kColumns>& factors : of.factors) {
      for (size_t c = 0; c < kColumns; ++c) {
        int32_t* const sums = of.sums[c] + block * WeightLine::kUnits;
        for (size_t unit = 0; unit < WeightLine::kUnits; ++unit) {
          const auto [first, second] = line->weights[unit];
          sums[unit] += first * factors[c][0] + second * factors[c][1];
        }
      }
      ++line;
    }
  }
}

template <size_t kColumns>
void AddWeights(const WeightSums<kColumns>& of) {
#if defined(__x86_64__)
  static const bool has_avx2 = HasAvx2();
  if (has_avx2) return EightByEight(of);
#endif
  AddWeightsOneByOne(of);
}

template void AddWeights(const WeightSums<1>& of);
template void AddWeights(const WeightSums<2>& of);
template void AddWeightsOneByOne(const WeightSums<1>& of);
template void AddWeightsOneByOne(const WeightSums<2>& of);

}  // namespace ossa::recon
