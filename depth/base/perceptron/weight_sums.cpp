// Integer sums do not depend on order: the vectorised code gives the same bits as the scalar one.
//
// Performance is limited by memory bandwidth. Reading all lines sequentially, including those of
// zero inputs, is three times as fast as skipping lines: the hardware prefetcher recognises a
// sequential stream, and software prefetching does not make up for it.
#include "depth/base/perceptron/weight_sums_internal.h"

#include <algorithm>
#include <bit>

#include "depth/base/cpu_dispatch.h"

#if defined(__x86_64__)
#include <immintrin.h>
#endif

namespace ossa {
namespace {

#if defined(__x86_64__)
// The sums of a block of units stay in registers over all pairs. Weights are widened once for all
// examples.
template <size_t kExamples>
__attribute__((target("avx2"))) void EightByEight(const WeightSums<kExamples>& of) {
  constexpr size_t kLanes = 8;  // 32-bit lanes of an AVX2 register
  constexpr size_t kGroups = WeightLine::kUnits / kLanes;
  const WeightLine* line = of.lines;
  for (size_t block = 0; block < of.blocks; ++block) {
    __m256i sum[kExamples][kGroups] = {};
    for (const PairFactors<kExamples>& pair : of.factors) {
      __m256i factors[kExamples];
      for (size_t e = 0; e < kExamples; ++e) {
        factors[e] = _mm256_set1_epi32(std::bit_cast<int32_t>(pair[e]));
      }
      const auto* const bytes = reinterpret_cast<const __m128i*>(line++);
      for (size_t group = 0; group < kGroups; ++group) {
        const __m256i weights = _mm256_cvtepi8_epi16(_mm_load_si128(bytes + group));
        for (size_t e = 0; e < kExamples; ++e) {
          sum[e][group] = _mm256_add_epi32(sum[e][group], _mm256_madd_epi16(weights, factors[e]));
        }
      }
    }
    for (size_t e = 0; e < kExamples; ++e) {
      auto* const sums = reinterpret_cast<__m256i*>(of.sums[e] + block * WeightLine::kUnits);
      for (size_t group = 0; group < kGroups; ++group) {
        _mm256_storeu_si256(sums + group, sum[e][group]);
      }
    }
  }
}
#endif

}  // namespace

template <size_t kExamples>
void AddWeightsOneByOne(const WeightSums<kExamples>& of) {
  const WeightLine* line = of.lines;
  for (size_t block = 0; block < of.blocks; ++block) {
    for (int32_t* const sums : of.sums) {
      std::fill_n(sums + block * WeightLine::kUnits, WeightLine::kUnits, 0);
    }
    for (const PairFactors<kExamples>& factors : of.factors) {
      for (size_t e = 0; e < kExamples; ++e) {
        int32_t* const sums = of.sums[e] + block * WeightLine::kUnits;
        for (size_t unit = 0; unit < WeightLine::kUnits; ++unit) {
          const auto [first, second] = line->weights[unit];
          sums[unit] += first * factors[e][0] + second * factors[e][1];
        }
      }
      ++line;
    }
  }
}

template <size_t kExamples>
void AddWeights(const WeightSums<kExamples>& of) {
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

}  // namespace ossa
