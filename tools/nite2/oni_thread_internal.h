#pragma once
#include <atomic>
#include <functional>
#include <utility>

#include "depth/sensor/openni2/lasting_thread.h"

namespace ossa::nite2 {

/// The one thread that opens and closes objects of OpenNI2.
class OniThread {
 public:
  static OniThread& Instance() {
    static auto* instance = new OniThread;  // lives as long as its thread, to the program's end
    return *instance;
  }

  /// Runs the task on the thread and waits; rethrows its exception.
  void Run(const std::function<void()>& task) { thread_.Run(task); }
  /// Queues the task.
  void Post(std::function<void()> task) { thread_.Post(std::move(task)); }
  /// Number of shutdowns of OpenNI2, which invalidate older objects. Compare it on the thread.
  int generation() const { return generation_; }
  void EndGeneration() { ++generation_; }

 private:
  OniThread() = default;

  depth::LastingThread& thread_ = *new depth::LastingThread;
  std::atomic<int> generation_ = 0;
};

}  // namespace ossa::nite2
