#pragma once
#include <cstddef>
#include <functional>

namespace ossa::people {

/// body(i) for each i < count, on at most `threads` threads; in order when one is enough.
void ParallelFor(size_t count, int threads, const std::function<void(size_t)>& body);

}  // namespace ossa::people
