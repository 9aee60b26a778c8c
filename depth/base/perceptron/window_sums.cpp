// Integer sums do not depend on order: the vectorised code gives the same bits as the scalar one.
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
// Several windows at a time: their sums stay in registers over all pairs, and each weight line is
// loaded once.
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
  constexpr size_t kAtOnce = 6;  // with two registers each: uses all AVX2 registers for sums
  const size_t count = windows.first.size();
  size_t w = 0;
  for (; w + kAtOnce <= count; w += kAtOnce) SumSome<kAtOnce>(windows, w, lines, sums, stride);
  for (; w + 2 <= count; w += 2) SumSome<2>(windows, w, lines, sums, stride);
  if (w < count) SumSome<1>(windows, w, lines, sums, stride);
}

// The AVX-512 version: a line is one register, and one instruction multiplies and accumulates.
template <size_t kWindows>
__attribute__((target("avx512f,avx512vnni"))) void SumSomeVnni(const Windows& windows, size_t first,
                                                               const OutputLine* line,
                                                               int32_t* sums, size_t stride) {
  static_assert(sizeof(OutputLine) == sizeof(__m512i));
  __m512i sum[kWindows] = {};
  for (size_t row = 0; row < windows.rows; ++row) {
    const int16_t* numbers[kWindows];
    for (size_t w = 0; w < kWindows; ++w) {
      numbers[w] = windows.first[first + w] + row * windows.stride;
    }
    for (size_t pair = 0; pair < windows.pairs; ++pair, ++line) {
      const __m512i weights = _mm512_load_si512(line);
      for (size_t w = 0; w < kWindows; ++w) {
        int32_t both;
        std::memcpy(&both, numbers[w] + 2 * pair, sizeof(both));
        sum[w] = _mm512_dpwssd_epi32(sum[w], weights, _mm512_set1_epi32(both));
      }
    }
  }
  for (size_t w = 0; w < kWindows; ++w) {
    _mm512_storeu_si512(sums + (first + w) * stride, sum[w]);
  }
}

void SumWithVnni(const Windows& windows, const OutputLine* lines, int32_t* sums, size_t stride) {
  constexpr size_t kAtOnce = 12;  // by measurement: sums enough for an instruction's latency, and
                                  // still a register each for where their windows begin
  const size_t count = windows.first.size();
  size_t w = 0;
  for (; w + kAtOnce <= count; w += kAtOnce) SumSomeVnni<kAtOnce>(windows, w, lines, sums, stride);
  for (; w + 4 <= count; w += 4) SumSomeVnni<4>(windows, w, lines, sums, stride);
  for (; w < count; ++w) SumSomeVnni<1>(windows, w, lines, sums, stride);
}
#endif

}  // namespace

std::vector<WindowSums> ListWindowSums() {
  std::vector<WindowSums> fastest_first;
#if defined(__x86_64__)
  const bool has_vnni =
      __builtin_cpu_supports("avx512f") != 0 && __builtin_cpu_supports("avx512vnni") != 0;
  if (has_vnni) fastest_first.push_back(SumWithVnni);
  if (HasAvx2()) fastest_first.push_back(SumSideBySide);
#endif
  fastest_first.push_back(SumWindowsOneByOne);
  return fastest_first;
}

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
  static const WindowSums fastest = ListWindowSums().front();
  fastest(windows, lines, sums, stride);
}

}  // namespace ossa
