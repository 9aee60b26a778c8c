#include "tools/nite2/frame_reader_internal.h"

#include <algorithm>
#include <thread>
#include <vector>

namespace ossa::nite2 {

using std::chrono::milliseconds;

FrameReader& FrameReader::Instance() {
  static auto* instance = new FrameReader;  // as its thread, until the program ends
  return *instance;
}

FrameReader::FrameReader() {
  std::thread([this] { Run(); }).detach();
}

OniFrame* FrameReader::Read(OniStreamHandle stream, milliseconds timeout,
                            const std::function<void()>& look) {
  Want want{stream, &look};
  std::unique_lock lock(mutex_);
  wants_.push_back(&want);
  changed_.notify_all();
  const auto is_done = [&] { return want.done; };
  if (!changed_.wait_for(lock, timeout, is_done)) {
    want.leaving = true;
    changed_.wait(lock, is_done);
  }
  return want.frame;
}

void FrameReader::Finish(Want& want) {
  wants_.erase(std::find(wants_.begin(), wants_.end(), &want));
  want.done = true;
  changed_.notify_all();
}

void FrameReader::Run() {
  std::unique_lock lock(mutex_);
  for (;;) {
    changed_.wait(lock, [this] { return !wants_.empty(); });
    Serve(lock);
  }
}

// One short wait for all streams that are requested now, so that new requests join soon.
void FrameReader::Serve(std::unique_lock<std::mutex>& lock) {
  constexpr milliseconds kSlice{10};  // by hand
  for (Want* want : std::deque<Want*>(wants_)) {
    if (want->leaving) Finish(*want);
  }
  const std::deque<Want*> served = wants_;
  if (served.empty()) return;
  std::vector<OniStreamHandle> streams;
  for (const Want* want : served) streams.push_back(want->stream);
  lock.unlock();
  int ready = -1;
  OniFrame* frame = nullptr;
  const OniStatus status = oniWaitForAnyStream(streams.data(), static_cast<int>(streams.size()),
                                               &ready, static_cast<int>(kSlice.count()));
  const bool readable = status == ONI_STATUS_OK && ready >= 0;
  if (readable &&
      oniStreamReadFrame(streams[static_cast<size_t>(ready)], &frame) != ONI_STATUS_OK) {
    frame = nullptr;
  }
  if (status != ONI_STATUS_OK && status != ONI_STATUS_TIME_OUT) std::this_thread::sleep_for(kSlice);
  if (frame != nullptr) (*served[static_cast<size_t>(ready)]->look)();
  lock.lock();
  if (!readable) return;
  Want& want = *served[static_cast<size_t>(ready)];  // valid until it is finished
  want.frame = frame;
  Finish(want);
}

}  // namespace ossa::nite2
