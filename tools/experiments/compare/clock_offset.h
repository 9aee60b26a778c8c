#pragma once
#include <functional>

#include "tools/experiments/compare/joint_track.h"

namespace ossa::tools {

/// The clock of a result against that of the truth.
struct ClockMatch {
  double offset_s = 0.0;     // to add to the times of the result
  double correlation = 0.0;  // of the joints' speeds then, [-1, 1]; 0: nothing to go by
};

/// The offset within `max_offset_s` so that the result's joint speeds match those of the truth
/// best: the peak of their normalised cross-correlation on a 10 ms grid, refined by a parabola.
/// Throws Interruption (tools/experiments/experiment.h) once `stop`, asked at each offset, says so.
ClockMatch MatchClocks(const JointTrack& truth, const JointTrack& result, double max_offset_s,
                       const std::function<bool()>& stop = {});

/// The offset between clocks of which nothing is known: both recordings began together, or the
/// clocks are one, whichever the speeds say, within `max_offset_s`. Neither is empty. `stop` as of
/// MatchClocks.
double FindClockOffset_s(const JointTrack& truth, const JointTrack& result, double max_offset_s,
                         const std::function<bool()>& stop = {});

}  // namespace ossa::tools
