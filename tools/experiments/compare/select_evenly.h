#pragma once
#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

namespace ossa::tools {

/// At most `most` of the elements, evenly spaced, in their order.
template <typename T>
std::vector<T> SelectEvenly(std::vector<T> all, size_t most) {
  if (all.size() <= most) return all;
  std::vector<T> selected;
  for (size_t i = 0; i < most; ++i) selected.push_back(std::move(all[i * all.size() / most]));
  return selected;
}

}  // namespace ossa::tools
