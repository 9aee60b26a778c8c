#include "depth/base/threads.h"

#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>

#include <algorithm>
#include <map>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

namespace ossa {

namespace tbb = oneapi::tbb;

namespace {

using Arena = std::unique_ptr<tbb::task_arena>;

// The arenas that nobody uses, by number of threads. They are used again because oneTBB 2021.8
// loses 7 kB with each arena that ends, and a tracker needs some for every frame.
class IdleArenas {
 public:
  Arena Take(int threads) {
    const std::lock_guard lock(mutex_);
    std::vector<Arena>& idle = idle_[threads];
    if (idle.empty()) return std::make_unique<tbb::task_arena>(threads);
    Arena arena = std::move(idle.back());
    idle.pop_back();
    return arena;
  }
  void Return(int threads, Arena arena) {
    const std::lock_guard lock(mutex_);
    idle_[threads].push_back(std::move(arena));
  }

 private:
  std::mutex mutex_;
  std::map<int, std::vector<Arena>> idle_;
};

// Never destroyed: at the end of a program other threads may still be in a loop.
IdleArenas& Idle() {
  static auto* const arenas = new IdleArenas;
  return *arenas;
}

// An arena of one caller, for a scope.
class ArenaLoan {
 public:
  explicit ArenaLoan(int threads) : threads_(threads), arena_(Idle().Take(threads)) {}
  ~ArenaLoan() { Idle().Return(threads_, std::move(arena_)); }
  ArenaLoan(const ArenaLoan&) = delete;
  ArenaLoan& operator=(const ArenaLoan&) = delete;
  tbb::task_arena& operator*() const { return *arena_; }

 private:
  int threads_;
  Arena arena_;
};

}  // namespace

struct ThreadLimit::Control {
  tbb::global_control limit;
};

ThreadLimit::ThreadLimit(int threads)
    : control_(
          new Control{{tbb::global_control::max_allowed_parallelism,
                       threads > 0 ? static_cast<size_t>(threads)
                                   : std::max<size_t>(1, std::thread::hardware_concurrency())}}) {}

ThreadLimit::~ThreadLimit() = default;

void WithThreads(int threads, const std::function<void()>& body) {
  // TBB prints a warning to the program's standard error if asked for more threads than there are.
  const size_t there_are =
      tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism);
  const ArenaLoan arena(static_cast<int>(std::min(static_cast<size_t>(threads), there_are)));
  (*arena).execute(body);
}

void ParallelFor(size_t count, const std::function<void(size_t)>& body) {
  tbb::parallel_for(size_t{0}, count, body);
}

void ParallelFor(size_t count, int threads, const std::function<void(size_t)>& body) {
  if (threads <= 1 || count <= 1) {
    for (size_t i = 0; i < count; ++i) body(i);
    return;
  }
  WithThreads(threads, [&] { ParallelFor(count, body); });
}

}  // namespace ossa
