#include "depth/base/threads.h"

#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>

#include <algorithm>
#include <thread>

namespace ossa {

namespace tbb = oneapi::tbb;

struct ThreadLimit::Control {
  tbb::global_control limit;
};

ThreadLimit::ThreadLimit(int threads)
    : control_(
          new Control{{tbb::global_control::max_allowed_parallelism,
                       threads > 0 ? static_cast<size_t>(threads)
                                   : std::max<size_t>(1, std::thread::hardware_concurrency())}}) {}

ThreadLimit::~ThreadLimit() = default;

void ParallelFor(size_t count, const std::function<void(size_t)>& body) {
  tbb::parallel_for(size_t{0}, count, body);
}

void ParallelFor(size_t count, int threads, const std::function<void(size_t)>& body) {
  if (threads <= 1 || count <= 1) {
    for (size_t i = 0; i < count; ++i) body(i);
    return;
  }
  // TBB prints a warning to the program's standard error if asked for more threads than there are.
  const size_t there_are =
      tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism);
  tbb::task_arena arena(static_cast<int>(std::min(static_cast<size_t>(threads), there_are)));
  arena.execute([&] { ParallelFor(count, body); });
}

}  // namespace ossa
