#include "depth/sensor/openni2/lasting_thread.h"

#include <unistd.h>

#include <future>
#include <memory>
#include <utility>
#include <vector>

namespace ossa::depth {
namespace {

// Threads that are not in use.
struct IdleThreads {
  std::mutex mutex;
  std::vector<LastingThread*> threads;

  static IdleThreads& Instance() {
    static auto* instance = new IdleThreads;  // threads outlive static objects
    return *instance;
  }
};

}  // namespace

LastingThread::LastingThread() : process_(getpid()) {
  std::thread thread([this] { Work(); });
  id_ = thread.get_id();
  thread.detach();
}

// Whether the thread is unavailable (in a forked child): tasks then run on the caller's thread.
bool LastingThread::IsElsewhere() const {
  return std::this_thread::get_id() != id_ && getpid() == process_;
}

void LastingThread::Run(const std::function<void()>& task) {
  if (!IsElsewhere()) return task();
  // Shared, because the thread uses it slightly longer than the caller waits.
  const auto packaged = std::make_shared<std::packaged_task<void()>>(task);
  std::future<void> done = packaged->get_future();
  Post([packaged] { (*packaged)(); });
  done.get();
}

void LastingThread::Post(std::function<void()> task) {
  if (getpid() != process_) return task();
  {
    const std::lock_guard lock(mutex_);
    tasks_.push_back(std::move(task));
  }
  changed_.notify_one();
}

void LastingThread::Work() {
  std::unique_lock lock(mutex_);
  for (;;) {
    changed_.wait(lock, [this] { return !tasks_.empty(); });
    std::function<void()> task = std::move(tasks_.front());
    tasks_.pop_front();
    lock.unlock();
    task();
    task = nullptr;  // its destruction may post more tasks
    lock.lock();
  }
}

BorrowedThread::BorrowedThread() {
  IdleThreads& idle = IdleThreads::Instance();
  const std::lock_guard lock(idle.mutex);
  if (idle.threads.empty()) {
    thread_ = new LastingThread;
    return;
  }
  thread_ = idle.threads.back();
  idle.threads.pop_back();
}

BorrowedThread::~BorrowedThread() {
  IdleThreads& idle = IdleThreads::Instance();
  const std::lock_guard lock(idle.mutex);
  idle.threads.push_back(thread_);
}

}  // namespace ossa::depth
