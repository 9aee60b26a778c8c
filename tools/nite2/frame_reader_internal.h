#pragma once
#include <OniCAPI.h>

#include <chrono>
#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>

namespace ossa::nite2 {

/// Reads frames of all streams on one thread that never ends, for the reason of LastingThread;
/// another than that, since closing waits for callbacks, and they wait for frames.
class FrameReader {
 public:
  static FrameReader& Instance();

  /// The next frame of a stream, to be given back; null after `timeout`, or where it cannot be
  /// read. Any thread, one at a time for each stream. Nothing touches the stream once this has
  /// returned.
  /// `look` is called on that thread when the frame is read, to ask OpenNI2 what else it must know.
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
