#pragma once
#include <OniCAPI.h>

#include <chrono>
#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>

namespace ossa::nite2 {

/// Reads frames of all streams on one thread that never ends (see LastingThread). It is a separate
/// thread, because closing waits for callbacks, which wait for frames.
class FrameReader {
 public:
  static FrameReader& Instance();

  /// Reads the next frame of a stream, which the caller must release; null after `timeout` or on
  /// failure. Callable from any thread, one at a time per stream. After it returns the stream is
  /// not used any more. `look` is called on the reading thread after the frame is read, for further
  /// queries of OpenNI2.
  OniFrame* Read(OniStreamHandle stream, std::chrono::milliseconds timeout,
                 const std::function<void()>& look);

 private:
  struct Want {
    OniStreamHandle stream = nullptr;
    const std::function<void()>* look = nullptr;
    OniFrame* frame = nullptr;
    bool leaving = false;  // waits no longer
    bool done = false;     // the thread does not know it any more
  };

  FrameReader();
  [[noreturn]] void Run();
  void Serve(std::unique_lock<std::mutex>& lock);
  void Finish(Want& want);

  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Want*> wants_;
};

}  // namespace ossa::nite2
