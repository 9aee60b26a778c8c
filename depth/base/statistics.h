#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <utility>
#include <vector>

namespace ossa {

/// The element at `rank` (from 0) in ascending order; reorders the values. Precondition: there are
/// more than `rank` values.
template <typename T>
T SelectRank(std::span<T> values, size_t rank) {
  const auto place = values.begin() + static_cast<std::ptrdiff_t>(rank);
  std::nth_element(values.begin(), place, values.end());
  return *place;
}
template <typename T>
T SelectRank(std::vector<T>& values, size_t rank) {
  return SelectRank(std::span<T>(values), rank);
}

/// The median; for an even number of values the larger of the middle two. Precondition: not empty.
template <typename T>
T Median(std::vector<T> values) {
  return SelectRank(values, values.size() / 2);
}

/// The same; NaN of no values.
inline double MedianOrNan(std::vector<double> values) {
  return values.empty() ? std::numeric_limits<double>::quiet_NaN() : Median(std::move(values));
}

}  // namespace ossa
