#include "forest/thread_limit.h"

#include <oneapi/tbb/global_control.h>

#include <algorithm>
#include <thread>

namespace ossa::forest {

using oneapi::tbb::global_control;

struct ThreadLimit::Control {
  global_control limit;
};

ThreadLimit::ThreadLimit(int threads)
    : control_(
          new Control{{global_control::max_allowed_parallelism,
                       threads > 0 ? static_cast<size_t>(threads)
                                   : std::max<size_t>(1, std::thread::hardware_concurrency())}}) {}

ThreadLimit::~ThreadLimit() = default;

}  // namespace ossa::forest
