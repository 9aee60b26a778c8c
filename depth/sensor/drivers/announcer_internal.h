#pragma once
#include <chrono>
#include <condition_variable>
#include <functional>
#include <map>
#include <mutex>
#include <thread>

namespace ossa::depth {

/// Tells OpenNI2 of devices that come and go, on a thread of its own: OpenNI2 takes its locks for
/// that, which neither a stream's thread (joined under them) nor libfreenect's may wait for.
class Announcer {
 public:
  using Clock = std::chrono::steady_clock;

  Announcer();
  ~Announcer();  // what was not announced by then never is
  Announcer(const Announcer&) = delete;
  Announcer& operator=(const Announcer&) = delete;

  /// Announcements are made at their times, those of one time in the order they came.
  void At(Clock::time_point when, std::function<void()> announce);
  void Now(std::function<void()> announce) { At(Clock::now(), std::move(announce)); }

 private:
  void Run();

  std::mutex mutex_;
  std::condition_variable wake_;
  std::multimap<Clock::time_point, std::function<void()>> due_;
  bool stopping_ = false;
  std::thread thread_;
};

}  // namespace ossa::depth
