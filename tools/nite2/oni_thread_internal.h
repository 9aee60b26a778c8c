#pragma once
#include <atomic>
#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>
#include <thread>

namespace ossa::nite2 {

/// The one thread, which never ends, that opens and closes what is OpenNI2's. OpenNI2 keeps a list
/// of all threads that ever called it and looks whether they are alive when a new one does; the C
/// library of today crashes at that for one that has ended. So no thread of the program may call.
class OniThread {
 public:
  static OniThread& Instance();

  /// Does it there and waits; throws what it throws.
  void Run(const std::function<void()>& task);
  /// How often OpenNI2 was shut down: what is older is gone with it. To be compared on the thread.
  int generation() const { return generation_; }
  void EndGeneration() { ++generation_; }
  /// Does it there some time, after what was asked for before.
  void Post(std::function<void()> task);

 private:
  OniThread();
  [[noreturn]] void Work();

  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<std::function<void()>> tasks_;
  std::thread::id id_;
  std::atomic<int> generation_ = 0;
};

}  // namespace ossa::nite2
