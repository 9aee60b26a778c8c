#pragma once
#include <cstdint>
#include <functional>
#include <map>
#include <utility>
#include <vector>

namespace ossa::depth {

struct TimedDepth {
  double time_s = 0.0;
  std::vector<uint16_t> depth;  // row-major, height × width
};

/// Reorders frames by time stamp. Several frames are buffered; frames that arrive even later are
/// dropped, so that time never runs backwards. If consecutive frames are too late, the clock was
/// set back: times continue from there.
class StampOrder {
 public:
  /// Receives each frame, with the number of frames dropped before it.
  using Give = std::function<void(TimedDepth frame, int64_t dropped)>;
  explicit StampOrder(Give give) : give_(std::move(give)) {}

  void Add(TimedDepth frame) {
    const double stamp_s = frame.time_s;
    frame.time_s += set_back_s_;
    if (given_ && frame.time_s < last_s_) return LeaveOut(stamp_s);
    late_in_a_row_ = 0;
    held_.emplace(frame.time_s, std::move(frame.depth));
    if (held_.size() > kHeld) GiveFirst();
  }
  /// Emits the buffered frames.
  void Finish() {
    while (!held_.empty()) GiveFirst();
  }
  /// Frames dropped so far.
  int64_t late() const { return late_; }

 private:
  static constexpr size_t kHeld = 8;  // frames, a quarter of a second at 30 Hz; by hand

  void LeaveOut(double stamp_s) {
    ++late_;
    ++dropped_;
    if (++late_in_a_row_ < kHeld) return;
    Finish();
    set_back_s_ = last_s_ - stamp_s;
    late_in_a_row_ = 0;
  }

  void GiveFirst() {
    auto first = held_.extract(held_.begin());
    given_ = true;
    last_s_ = first.key();
    give_({first.key(), std::move(first.mapped())}, std::exchange(dropped_, 0));
  }

  Give give_;
  std::multimap<double, std::vector<uint16_t>> held_;  // by time
  bool given_ = false;
  double last_s_ = 0.0;
  double set_back_s_ = 0.0;  // amount by which the clock was set back
  size_t late_in_a_row_ = 0;
  int64_t late_ = 0, dropped_ = 0;
};

}  // namespace ossa::depth
