// Sums of whole numbers are the same in any order: what runs on eight outputs side by side says,
// bit for bit, what one by one says.
#include "depth/base/perceptron/window_sums_internal.h"

#include <algorithm>
#include <cstring>

#include "depth/base/cpu_dispatch.h"

#if defined(__x86_64__)
#include <immintrin.h>
#endif

namespace ossa {
namespace {

#if defined(__x86_64__)
// Some windows at a time: registers hold their sums while all pairs go by, and a line is fetched
// once for them.
template <size_t kWindows>
__attribute__((target("avx2"))) void SumSome(const Windows& windows, size_t first,
                                             const OutputLine* line, int32_t* sums, size_t stride) {
  constexpr size_t kGroups = sizeof(OutputLine) / sizeof(__m256i);
  __m256i sum[kWindows][kGroups] = {};
  for (size_t row = 0; row < windows.rows; ++row) {
    const int16_t* numbers[kWindows];
    for (size_t w = 0; w < kWindows; ++w) {
      numbers[w] = windows.first[first + w] + row * windows.stride;
    }
    for (size_t pair = 0; pair < windows.pairs; ++pair, ++line) {
      const auto* const weights = reinterpret_cast<const __m256i*>(line);
      const __m256i left = _mm256_load_si256(weights), right = _mm256_load_si256(weights + 1);
      for (size_t w = 0; w < kWindows; ++w) {
        int32_t both;
        std::memcpy(&both, numbers[w] + 2 * pair, sizeof(both));
        const __m256i factor = _mm256_set1_epi32(both);
        sum[w][0] = _mm256_add_epi32(sum[w][0], _mm256_madd_epi16(left, factor));
        sum[w][1] = _mm256_add_epi32(sum[w][1], _mm256_madd_epi16(right, factor));
      }
    }
  }
  for (size_t w = 0; w < kWindows; ++w) {
    auto* const out = reinterpret_cast<__m256i*>(sums + (first + w) * stride);
    for (size_t group = 0; group < kGroups; ++group) {
      _mm256_storeu_si256(out + group, sum[w][group]);
    }
  }
}

void SumSideBySide(const Windows& windows, const OutputLine* lines, int32_t* sums, size_t stride) {
  constexpr size_t kAtOnce = 6;  // with two groups each: as many sums as AVX2 has registers for
  const size_t count = windows.first.size();
  size_t w = 0;
  for (; w + kAtOnce <= count; w += kAtOnce) SumSome<kAtOnce>(windows, w, lines, sums, stride);
  for (; w + 2 <= count; w += 2) SumSome<2>(windows, w, lines, sums, stride);
  if (w < count) SumSome<1>(windows, w, lines, sums, stride);
}
#endif

}  // namespace

void SumWindowsOneByOne(const Windows& windows, const OutputLine* lines, int32_t* sums,
                        size_t stride) {
  for (const int16_t* const first : windows.first) {
    std::array<int32_t, OutputLine::kOutputs> sum{};
    const OutputLine* line = lines;
    for (size_t row = 0; row < windows.rows; ++row) {
      const int16_t* number = first + row * windows.stride;
      for (size_t pair = 0; pair < windows.pairs; ++pair, ++line, number += 2) {
        for (size_t o = 0; o < OutputLine::kOutputs; ++o) {
          sum[o] += line->weights[o][0] * number[0] + line->weights[o][1] * number[1];
        }
      }
    }
    std::copy(sum.begin(), sum.end(), sums);
    sums += stride;
  }
}

void SumWindows(const Windows& windows, const OutputLine* lines, int32_t* sums, size_t stride) {
#if defined(__x86_64__)
  static const bool has_avx2 = HasAvx2();
  if (has_avx2) return SumSideBySide(windows, lines, sums, stride);
#endif
  SumWindowsOneByOne(windows, lines, sums, stride);
}

}  // namespace ossa
