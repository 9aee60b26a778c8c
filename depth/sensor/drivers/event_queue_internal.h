#pragma once
#include <chrono>
#include <condition_variable>
#include <functional>
#include <map>
#include <mutex>
#include <thread>

namespace ossa::depth {

/// Notifies OpenNI2 of connected and disconnected devices, on its own thread: OpenNI2 takes locks
/// for that, which neither a stream's thread (joined under them) nor libfreenect's may wait for.
class EventQueue {
 public:
  using Clock = std::chrono::steady_clock;

  EventQueue();
  ~EventQueue();  // pending events are dropped
  EventQueue(const EventQueue&) = delete;
  EventQueue& operator=(const EventQueue&) = delete;

  /// Schedules an event. Events with equal times run in order of their calls.
  void At(Clock::time_point when, std::function<void()> event);
  void Now(std::function<void()> event) { At(Clock::now(), std::move(event)); }

 private:
  void Run();

  std::mutex mutex_;
  std::condition_variable wake_;
  std::multimap<Clock::time_point, std::function<void()>> due_;
  bool stopping_ = false;
  std::thread thread_;
};

}  // namespace ossa::depth
