#include "depth/sensor/drivers/announcer_internal.h"
#include "depth/sensor/shutdown_gate_internal.h"

namespace ossa::depth {

Announcer::Announcer() : thread_([this] { Run(); }) {}

Announcer::~Announcer() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  wake_.notify_all();
  thread_.join();
}

void Announcer::At(Clock::time_point when, std::function<void()> announce) {
  {
    const std::lock_guard lock(mutex_);
    due_.emplace(when, std::move(announce));
  }
  wake_.notify_all();
}

void Announcer::Run() {
  // A shutdown that closes the gate may be that of another user of OpenNI2, after which it is open
  // again: what was held up is tried anew.
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
    const std::function<void()> announce = first->second;
    lock.unlock();
    const bool announced = AnnounceUnlessShuttingDown(announce);
    lock.lock();
    if (announced) {
      due_.erase(first);  // iterators of a map survive what was added meanwhile
    } else {
      wake_.wait_for(lock, kAgainAfter);
    }
  }
}

}  // namespace ossa::depth
