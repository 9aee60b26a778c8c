#pragma once
#include <optional>
#include <string>

#include "recon/skeleton_sequence.h"

namespace ossa::recon {

/// The median length of thighs, shins and upper arms, in the unit of the positions; none without
/// any.
std::optional<double> MedianLimb(const SkeletonSequence& sequence);

/// A warning if the body size shows that the file's stated unit is wrong; "" if it is plausible.
/// Without it, people a thousand times too large would be read silently.
std::string DescribeUnlikelyUnit(const SkeletonSequence& sequence);

/// A warning if the frames are so far apart, or so close, that their times cannot be seconds; "" if
/// they can. Filters and methods would take every frame for a new recording.
std::string DescribeUnlikelyTimes(const SkeletonSequence& sequence);

}  // namespace ossa::recon
