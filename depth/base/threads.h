#pragma once
#include <cstddef>
#include <functional>
#include <memory>

namespace ossa {

/// Limits the number of threads of parallel loops during its lifetime; 0: one per core.
class ThreadLimit {
 public:
  explicit ThreadLimit(int threads);
  ~ThreadLimit();
  ThreadLimit(const ThreadLimit&) = delete;
  ThreadLimit& operator=(const ThreadLimit&) = delete;

 private:
  struct Control;
  std::unique_ptr<Control> control_;
};

/// Calls `body`, whose parallel loops use at most `threads` threads, > 0. Loops of several callers
/// at once keep apart.
void WithThreads(int threads, const std::function<void()>& body);

/// Calls body(i) for each i < count, on as many threads as ThreadLimit allows.
void ParallelFor(size_t count, const std::function<void(size_t)>& body);
/// As above on at most `threads` threads; in order if one is enough.
void ParallelFor(size_t count, int threads, const std::function<void(size_t)>& body);

}  // namespace ossa
