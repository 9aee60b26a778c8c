#include "tools/nite2/oni_thread_internal.h"

#include <future>
#include <memory>

namespace ossa::nite2 {

OniThread& OniThread::Instance() {
  static auto* instance = new OniThread;  // lives as long as its thread, to the program's end
  return *instance;
}

OniThread::OniThread() {
  std::thread thread([this] { Work(); });
  id_ = thread.get_id();
  thread.detach();
}

void OniThread::Run(const std::function<void()>& task) {
  if (std::this_thread::get_id() == id_) return task();
  std::packaged_task<void()> packaged(task);
  std::future<void> done = packaged.get_future();
  Post([&packaged] { packaged(); });
  done.get();
}

void OniThread::Post(std::function<void()> task) {
  {
    const std::lock_guard lock(mutex_);
    tasks_.push_back(std::move(task));
  }
  changed_.notify_one();
}

void OniThread::Work() {
  std::unique_lock lock(mutex_);
  for (;;) {
    changed_.wait(lock, [this] { return !tasks_.empty(); });
    const std::function<void()> task = std::move(tasks_.front());
    tasks_.pop_front();
    lock.unlock();
    task();
    lock.lock();
  }
}

}  // namespace ossa::nite2
