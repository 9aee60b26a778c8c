#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "depth/base/perceptron/quantised_perceptron.h"

namespace ossa {

/// The factors of a pair of inputs, for each example.
template <size_t kExamples>
using PairFactors = std::array<std::array<int16_t, 2>, kExamples>;

/// Computes a layer's sums of weights times factors, one per unit and example.
template <size_t kExamples>
struct WeightSums {
  std::span<const PairFactors<kExamples>> factors;  // of all pairs
  const WeightLine* lines = nullptr;                // all pairs for the first units, then the next
  size_t blocks = 0;                                // of units
  std::array<int32_t*, kExamples> sums{};           // WeightLine::kUnits per block
};

/// For one or two examples. Precondition: no partial sum reaches 2^31, in any order.
template <size_t kExamples>
void AddWeights(const WeightSums<kExamples>& of);

/// Scalar reference implementation.
template <size_t kExamples>
void AddWeightsOneByOne(const WeightSums<kExamples>& of);

}  // namespace ossa
