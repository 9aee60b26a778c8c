#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "recon/models/network_runner.h"

namespace ossa::recon {

/// What the weights of a pair of inputs are taken times, in each column.
template <size_t kColumns>
using PairFactors = std::array<std::array<int16_t, 2>, kColumns>;

/// A layer's sums of weights times factors, of each column one a unit.
template <size_t kColumns>
struct WeightSums {
  std::span<const PairFactors<kColumns>> factors;  // of all pairs
  const WeightLine* lines = nullptr;      // of all pairs for the first units, then the next
  size_t blocks = 0;                      // of units
  std::array<int32_t*, kColumns> sums{};  // WeightLine::kUnits a block
};

/// Of one column or two. Precondition: no sum reaches 2^31, in whatever order its terms are added.
template <size_t kColumns>
void AddWeights(const WeightSums<kColumns>& of);

/// The same, one unit after the other.
template <size_t kColumns>
void AddWeightsOneByOne(const WeightSums<kColumns>& of);

}  // namespace ossa::recon
