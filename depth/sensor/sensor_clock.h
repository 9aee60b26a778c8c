#pragma once
#include <cstdint>
#include <optional>

namespace ossa::depth {

/// Converts the time stamps of a sensor's frames to times that never run backwards. Where the
/// sensor's clock starts again, because its counter overflowed or the recording was played in a
/// loop, times continue a thirtieth of a second after the last.
class SensorClock {
 public:
  /// The time of the next frame, seconds.
  double TimeOf(uint64_t stamp_us) {
    constexpr double kMicrosecond = 1e-6;  // in seconds; by definition
    return TimeOf(static_cast<double>(stamp_us) * kMicrosecond);
  }
  double TimeOf(double stamp_s) {
    constexpr double kPeriod_s = 1.0 / 30.0;  // of the usual depth camera; by convention
    if (last_stamp_s_ && stamp_s < *last_stamp_s_) SetTime(last_s_ + kPeriod_s, stamp_s);
    last_stamp_s_ = stamp_s;
    return last_s_ = stamp_s + offset_s_;
  }
  /// From here on the stamp means this time.
  void SetTime(double time_s, double stamp_s) {
    offset_s_ = time_s - stamp_s;
    last_stamp_s_ = stamp_s;
  }

 private:
  double offset_s_ = 0.0;  // time minus stamp
  double last_s_ = 0.0;
  std::optional<double> last_stamp_s_;
};

}  // namespace ossa::depth
