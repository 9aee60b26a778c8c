#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

namespace ossa {

/// The element that would stand at `rank` (from 0) if the values were in ascending order; they are
/// rearranged. Precondition: there are more than `rank` of them.
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

/// The median; of an even number of values the upper of the middle two. Precondition: there is one.
template <typename T>
T Median(std::vector<T> values) {
  return SelectRank(values, values.size() / 2);
}

}  // namespace ossa
