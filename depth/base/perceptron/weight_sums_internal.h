#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "depth/base/perceptron/quantised_perceptron.h"

namespace ossa {

/// What the weights of a pair of inputs are taken times, in each example.
template <size_t kExamples>
using PairFactors = std::array<std::array<int16_t, 2>, kExamples>;

/// A layer's sums of weights times factors, of each example one a unit.
template <size_t kExamples>
struct WeightSums {
  std::span<const PairFactors<kExamples>> factors;  // of all pairs
  const WeightLine* lines = nullptr;       // of all pairs for the first units, then the next
  size_t blocks = 0;                       // of units
  std::array<int32_t*, kExamples> sums{};  // WeightLine::kUnits a block
};

/// Of one example or two. Precondition: no sum reaches 2^31, in whatever order its terms are added.
template <size_t kExamples>
void AddWeights(const WeightSums<kExamples>& of);

/// The same, one unit after the other.
template <size_t kExamples>
void AddWeightsOneByOne(const WeightSums<kExamples>& of);

}  // namespace ossa
