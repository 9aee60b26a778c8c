#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace ossa {

/// The weights of a pair of neighbouring numbers of a window for as many outputs as fill a line of
/// the cache: of each output that of the first number and that of the second.
struct alignas(64) OutputLine {
  static constexpr size_t kOutputs = 16;  // of 4 bytes: derived, a cache line
  std::array<std::array<int16_t, 2>, kOutputs> weights{};
};

/// Windows of a map of whole numbers, each of `rows` rows of `pairs` pairs of numbers, whose rows
/// begin `stride` numbers apart.
struct Windows {
  std::span<const int16_t* const> first;  // number of each window
  size_t rows = 0, pairs = 0;
  size_t stride = 0;
};

/// Of each window the sums of its numbers times the weights, of as many outputs as a line has: of a
/// window `stride` sums from those of the window before. Lines: of a window's pairs, in order.
/// Precondition: no sum reaches 2^31, in whatever order its terms are added.
void SumWindows(const Windows& windows, const OutputLine* lines, int32_t* sums, size_t stride);

/// The same, one number after the other.
void SumWindowsOneByOne(const Windows& windows, const OutputLine* lines, int32_t* sums,
                        size_t stride);

/// What SumWindows may do on this processor, the fastest first; all say the same.
using WindowSums = void (*)(const Windows& windows, const OutputLine* lines, int32_t* sums,
                            size_t stride);
std::vector<WindowSums> ListWindowSums();

}  // namespace ossa
