#pragma once
#include <algorithm>
#include <deque>
#include <memory>
#include <mutex>

#include "tools/nite2/depth_camera_internal.h"

namespace ossa::nite2 {

// Constants: by hand.

inline constexpr size_t kRetired =
    8;  // frames kept after their end, for programs that still use one
inline constexpr size_t kHalfHeld = 120;  // frames that were released too seldom: four seconds

/// The frames that a program holds, with reference counts. Unknown frames are reported: those
/// released twice, or after their tracker. `Stored` has a member `frame`, which the program sees,
/// and `delivered`, the depth frame.
///
/// The PyPI package openni takes two references to every frame and releases one: a frame that was
/// released at least once stays only among the newest kHalfHeld of its kind, or memory would run
/// out within minutes.
template <typename Stored>
class HeldFrames {
 public:
  using Frame = decltype(Stored::frame);

  /// With one reference.
  Frame* Add(std::unique_ptr<Stored> stored) {
    const std::lock_guard lock(mutex_);
    held_.push_back({std::move(stored), 1, false});
    Frame* frame = &held_.back().stored->frame;
    DropHalfHeld();
    return frame;
  }

  bool AddRef(const Frame* frame) {
    const std::lock_guard lock(mutex_);
    const auto found = Find(frame);
    if (found == held_.end()) return false;
    ++found->count;
    return true;
  }

  bool Release(const Frame* frame) {
    const std::lock_guard lock(mutex_);
    const auto found = Find(frame);
    if (found == held_.end()) return false;
    found->released = true;
    if (--found->count == 0) Retire(found);
    return true;
  }

  size_t size() const {
    const std::lock_guard lock(mutex_);
    return held_.size();
  }

 private:
  struct Held {
    std::unique_ptr<Stored> stored;
    int count = 0;
    bool released = false;
  };
  using Place = typename std::deque<Held>::iterator;

  Place Find(const Frame* frame) {
    return std::find_if(held_.begin(), held_.end(),
                        [&](const Held& held) { return &held.stored->frame == frame; });
  }

  // Memory is not used again at once: a second release must not meet another frame.
  void Retire(Place place) {
    place->stored->delivered.reset();
    retired_.push_back(std::move(place->stored));
    if (retired_.size() > kRetired) retired_.pop_front();
    held_.erase(place);
  }

  void DropHalfHeld() {
    const auto is_half_held = [](const Held& held) { return held.released; };
    auto over =
        std::count_if(held_.begin(), held_.end(), is_half_held) - static_cast<ptrdiff_t>(kHalfHeld);
    for (; over > 0; --over) Retire(std::find_if(held_.begin(), held_.end(), is_half_held));
  }

  mutable std::mutex mutex_;
  std::deque<Held> held_;
  std::deque<std::unique_ptr<Stored>> retired_;
};

}  // namespace ossa::nite2
