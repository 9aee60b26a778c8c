#pragma once
#include <cstddef>
#include <exception>
#include <functional>
#include <vector>

#include "depth/base/threads.h"

namespace ossa::forest {

/// Calls body(t) for each of so many trees, side by side. Where several throw, what the first of
/// them throws comes out: the same on every machine.
inline void ForEachTree(size_t trees, const std::function<void(size_t)>& body) {
  std::vector<std::exception_ptr> thrown(trees);
  ParallelFor(trees, [&](size_t t) {
    try {
      body(t);
    } catch (...) {
      thrown[t] = std::current_exception();
    }
  });
  for (const std::exception_ptr& each : thrown) {
    if (each != nullptr) std::rethrow_exception(each);
  }
}

}  // namespace ossa::forest
