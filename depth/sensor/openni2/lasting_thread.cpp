#include "depth/sensor/openni2/lasting_thread.h"

#include <unistd.h>

#include <future>
#include <memory>
#include <utility>
#include <vector>

namespace ossa::depth {
namespace {

// Threads that nobody has borrowed.
struct IdleThreads {
  std::mutex mutex;
  std::vector<LastingThread*> threads;

  static IdleThreads& Instance() {
    static auto* instance = new IdleThreads;  // threads outlive what ends with the program
    return *instance;
  }
};

}  // namespace

LastingThread::LastingThread() : process_(getpid()) {
  std::thread thread([this] { Work(); });
  id_ = thread.get_id();
  thread.detach();
}

// Where nobody would do it: it is done by whoever asks, as if there were no such thread.
bool LastingThread::IsElsewhere() const {
  return std::this_thread::get_id() != id_ && getpid() == process_;
}

void LastingThread::Run(const std::function<void()>& task) {
  if (!IsElsewhere()) return task();
  // Shared: the thread is in it for a moment longer than the wait lasts.
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
    task = nullptr;  // what goes with it may ask for more
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
