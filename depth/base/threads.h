#pragma once
#include <cstddef>
#include <functional>
#include <memory>

namespace ossa {

/// At most so many threads work in parallel loops while this lives; 0: one a core.
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

/// Calls body(i) for each i < count, on as many threads as ThreadLimit allows.
void ParallelFor(size_t count, const std::function<void(size_t)>& body);
/// The same on at most `threads` threads; in order when one is enough.
void ParallelFor(size_t count, int threads, const std::function<void(size_t)>& body);

}  // namespace ossa
