#pragma once
#include <cstddef>
#include <exception>
#include <functional>
#include <vector>

#include "depth/base/threads.h"

namespace ossa::forest {

/// Calls body(t) for each tree, in parallel. If several throw, the exception of the first tree is
/// rethrown: the same on every machine.
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
