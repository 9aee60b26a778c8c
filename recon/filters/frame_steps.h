#pragma once
#include <limits>
#include <optional>

namespace ossa::recon {

/// Seconds from one frame of a person to the next. A time that repeats, hardly grows, or runs back
/// by a few milliseconds, is the logger's doing, not the person's: such a frame counts as one that
/// comes as long after the frame before as that came after its own.
class FrameSteps {
 public:
  /// By hand, a sixth of a frame: how far back a time may run and still be the logger's doing.
  static constexpr double kJitter_s = 0.005;

  /// Nothing for the first frame, after a gap and when time runs backwards: what was before says
  /// nothing of now.
  std::optional<double> To(double time_s) {
    const double step_s = time_s - last_time_s_;
    if (step_s < kShortest_s && step_s > -kJitter_s) return step_s_;
    last_time_s_ = time_s;
    if (!(step_s > 0.0 && step_s <= kLongestGap_s)) {
      step_s_ = kUsual_s;
      return std::nullopt;
    }
    step_s_ = step_s;
    return step_s;
  }

 private:
  static constexpr double kShortest_s = 0.001;    // by hand: cameras have up to 300 frames a second
  static constexpr double kLongestGap_s = 0.5;    // by hand: 15 frames
  static constexpr double kUsual_s = 1.0 / 30.0;  // of a Kinect v1
  double last_time_s_ = -std::numeric_limits<double>::infinity();
  double step_s_ = kUsual_s;
};

}  // namespace ossa::recon
