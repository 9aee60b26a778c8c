#pragma once
#include <functional>

#include "tools/experiments/compare/joint_track.h"

namespace ossa::tools {

/// Offset of a result's clock from the truth's.
struct ClockMatch {
  double offset_s = 0.0;  // to add to the times of the result
  /// Significance of the correlation of the joints' speeds at this offset: Fisher's z in standard
  /// errors; 0: no correlation.
  double significance = 0.0;
};

/// The offset within `max_offset_s` at which result and truth agree best. Candidates are the peaks
/// of the normalised cross-correlation of the joints' speeds on a 10 ms grid; among them the one
/// wins whose positions, after rigid alignment, correlate most. It is refined by a parabola through
/// the correlation of the speeds. Throws Interruption (tools/experiments/experiment.h) if `stop`,
/// called at each offset, returns true.
ClockMatch MatchClocks(const JointTrack& truth, const JointTrack& result, double max_offset_s,
                       const std::function<bool()>& stop = {});

/// The offset between unknown clocks: either both recordings began together, or they share a clock;
/// the speeds decide, within `max_offset_s`. Neither recording may be empty. `stop` as in
/// MatchClocks().
double FindClockOffset_s(const JointTrack& truth, const JointTrack& result, double max_offset_s,
                         const std::function<bool()>& stop = {});

}  // namespace ossa::tools
