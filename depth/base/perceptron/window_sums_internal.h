#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace ossa {

/// The weights of a pair of adjacent numbers of a window for the outputs of a cache line: for each
/// output that of the first number and that of the second.
struct alignas(64) OutputLine {
  static constexpr size_t kOutputs = 16;  // of 4 bytes: derived, a cache line
  std::array<std::array<int16_t, 2>, kOutputs> weights{};
};

/// Windows of a quantised map, each of `rows` rows of `pairs` pairs of numbers; rows are `stride`
/// numbers apart.
struct Windows {
  std::span<const int16_t* const> first;  // pointer to the first number of each window
  size_t rows = 0, pairs = 0;
  size_t stride = 0;
};

/// For each window the sums of its numbers times the weights, for the outputs of one line; sums of
/// consecutive windows are `stride` apart. `lines`: one per pair of a window, in order.
/// Precondition: no partial sum reaches 2^31, in any order.
void SumWindows(const Windows& windows, const OutputLine* lines, int32_t* sums, size_t stride);

/// Scalar reference implementation.
void SumWindowsOneByOne(const Windows& windows, const OutputLine* lines, int32_t* sums,
                        size_t stride);

/// The implementations available on this processor, fastest first; all give the same result.
using WindowSums = void (*)(const Windows& windows, const OutputLine* lines, int32_t* sums,
                            size_t stride);
std::vector<WindowSums> ListWindowSums();

}  // namespace ossa
