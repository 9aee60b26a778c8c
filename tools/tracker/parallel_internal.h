#pragma once
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <cstddef>

namespace ossa::tracker {

/// body(i) for each i < count, on at most `threads` threads; in order when one is enough.
template <typename Body>
void ParallelFor(size_t count, int threads, const Body& body) {
  if (threads <= 1 || count <= 1) {
    for (size_t i = 0; i < count; ++i) body(i);
    return;
  }
  tbb::task_arena arena(threads);
  arena.execute([&] { tbb::parallel_for(size_t{0}, count, [&](size_t i) { body(i); }); });
}

}  // namespace ossa::tracker
