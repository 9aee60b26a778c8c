#pragma once
#include <limits>
#include <optional>

namespace ossa::recon {

/// Time steps between the frames of a person, seconds. A time that repeats, hardly grows, or runs
/// back by a few milliseconds is an artefact of logging: such a frame gets the same step as the
/// frame before it.
class FrameSteps {
 public:
  /// By hand, a sixth of a frame: how far a time may run back and still be an artefact.
  static constexpr double kJitter_s = 0.005;

  /// The step to `time_s`. Nothing for the first frame, after a gap and when time runs backwards:
  /// earlier frames are then of no use.
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
