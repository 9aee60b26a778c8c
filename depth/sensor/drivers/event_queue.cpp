#include "depth/sensor/drivers/event_queue_internal.h"
#include "depth/sensor/shutdown_gate_internal.h"

namespace ossa::depth {

EventQueue::EventQueue() : thread_([this] { Run(); }) {}

EventQueue::~EventQueue() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  wake_.notify_all();
  thread_.join();
}

void EventQueue::At(Clock::time_point when, std::function<void()> event) {
  {
    const std::lock_guard lock(mutex_);
    due_.emplace(when, std::move(event));
  }
  wake_.notify_all();
}

void EventQueue::Run() {
  // The gate may have been closed by a shutdown of another OpenNI2 user and open again later: retry
  // delayed events.
  constexpr std::chrono::milliseconds kAgainAfter{5};
  std::unique_lock lock(mutex_);
  while (!stopping_) {
    if (due_.empty()) {
      wake_.wait(lock);
      continue;
    }
    const auto first = due_.begin();
    if (Clock::now() < first->first) {
      wake_.wait_until(lock, first->first);
      continue;
    }
    const std::function<void()> event = first->second;
    lock.unlock();
    const bool announced = AnnounceUnlessShuttingDown(event);
    lock.lock();
    if (announced) {
      due_.erase(first);  // map iterators stay valid when elements are added
    } else {
      wake_.wait_for(lock, kAgainAfter);
    }
  }
}

}  // namespace ossa::depth
