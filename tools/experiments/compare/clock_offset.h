#pragma once
#include <functional>

#include "tools/experiments/compare/joint_track.h"

namespace ossa::tools {

/// The clock of a result against that of the truth.
struct ClockMatch {
  double offset_s = 0.0;  // to add to the times of the result
  /// How significant the correlation of the joints' speeds is then: Fisher's z in standard errors;
  /// 0: none.
  double significance = 0.0;
};

/// The offset within `max_offset_s` at which result and truth agree: of those at which the joints'
/// speeds correlate significantly, on a 10 ms grid, the one at which their positions, moved rigidly
/// onto each other, do so most; refined by a parabola through the speeds' normalised
/// cross-correlation.
/// Throws Interruption (tools/experiments/experiment.h) once `stop`, asked at each offset, says so.
ClockMatch MatchClocks(const JointTrack& truth, const JointTrack& result, double max_offset_s,
                       const std::function<bool()>& stop = {});

/// The offset between clocks of which nothing is known: both recordings began together, or the
/// clocks are one, whichever the speeds say, within `max_offset_s`. Neither is empty. `stop` as of
/// MatchClocks.
double FindClockOffset_s(const JointTrack& truth, const JointTrack& result, double max_offset_s,
                         const std::function<bool()>& stop = {});

}  // namespace ossa::tools
