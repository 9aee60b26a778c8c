#pragma once
#include <optional>

#include "tools/people/options.h"

namespace ossa::people {

/// The time between frames of a source, seconds.
class FrameRate {
 public:
  /// The shorter one of the last two steps: a frame that is lost is no change of rate. The only
  /// step of a recording's second frame; nothing at first, and where times stand still or run back.
  std::optional<double> Update(double time_s);

 private:
  std::optional<double> last_s_, step_s_;
};

/// The options for a source with this time between frames, > 0. Those that bridge frames are chosen
/// for 30 Hz; for a slower source they cover at least two frames, in which people go farther.
PeopleOptions AdaptToFrameRate(PeopleOptions options, double step_s);

}  // namespace ossa::people
