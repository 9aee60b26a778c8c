#pragma once
#include <chrono>
#include <optional>

namespace ossa::viewer {

/// When the frames of a recording are due that is played at its own speed. Gaps of more than a
/// second are skipped and times that run backwards begin anew, as those of a camera that was set up
/// again or of two recordings in one file: nobody waits an hour for what was an hour later.
class PlaybackClock {
 public:
  using Clock = std::chrono::steady_clock;

  /// Of a frame at `time_s` of the recording; of the same frame again the same.
  Clock::time_point DueAt(double time_s) {
    constexpr double kLongestGap_s = 1.0;  // by hand
    const bool follows = last_s_ && time_s >= *last_s_ && time_s - *last_s_ <= kLongestGap_s;
    if (!follows) start_ = Clock::now() - Seconds(time_s);
    last_s_ = time_s;
    return start_ + Seconds(time_s);
  }
  /// The next frame is due when it comes: it was waited for.
  void Restart() { last_s_.reset(); }

  static Clock::duration Seconds(double s) {
    return std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(s));
  }
  /// Of the last frame, which no other follows: as if one did; by convention.
  static Clock::duration LastFramesTime() { return Seconds(1.0 / 30.0); }

 private:
  Clock::time_point start_;
  std::optional<double> last_s_;
};

}  // namespace ossa::viewer
