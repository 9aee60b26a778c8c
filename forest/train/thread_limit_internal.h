#pragma once
#include <oneapi/tbb/global_control.h>

#include <algorithm>
#include <thread>

namespace ossa::forest {

/// At most so many threads work while this lives; 0: one a core.
class ThreadLimit {
 public:
  explicit ThreadLimit(int threads)
      : control_(oneapi::tbb::global_control::max_allowed_parallelism,
                 threads > 0 ? static_cast<size_t>(threads)
                             : std::max<size_t>(1, std::thread::hardware_concurrency())) {}

 private:
  oneapi::tbb::global_control control_;
};

}  // namespace ossa::forest
