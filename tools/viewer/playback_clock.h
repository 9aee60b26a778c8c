#pragma once
#include <chrono>
#include <optional>

namespace ossa::viewer {

/// Due times of the frames of a recording at its own speed. Gaps of more than a second are skipped,
/// and playback restarts where times run backwards, as in a file of two recordings.
class PlaybackClock {
 public:
  using Clock = std::chrono::steady_clock;

  /// Of a frame at `time_s` of the recording; the same for repeated calls.
  Clock::time_point DueAt(double time_s) {
    constexpr double kLongestGap_s = 1.0;  // by hand
    const bool follows = last_s_ && time_s >= *last_s_ && time_s - *last_s_ <= kLongestGap_s;
    if (!follows) start_ = Clock::now() - Seconds(time_s);
    last_s_ = time_s;
    return start_ + Seconds(time_s);
  }
  /// The next frame is due as soon as it comes.
  void Restart() { last_s_.reset(); }

  static Clock::duration Seconds(double s) {
    return std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(s));
  }
  /// How long the last frame is shown; by convention.
  static Clock::duration LastFramesTime() { return Seconds(1.0 / 30.0); }

 private:
  Clock::time_point start_;
  std::optional<double> last_s_;
};

}  // namespace ossa::viewer
