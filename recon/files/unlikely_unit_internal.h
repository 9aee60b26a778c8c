#pragma once
#include <optional>
#include <string>

#include "recon/skeleton_sequence.h"

namespace ossa::recon {

/// The median length of thighs, shins and upper arms, in the unit of the places; none without any.
std::optional<double> MedianLimb(const SkeletonSequence& sequence);

/// What is odd about people's size in a recording whose file states another unit than it is in, and
/// that would else be read in silence, a thousand times too large. "" where nothing is.
std::string DescribeUnlikelyUnit(const SkeletonSequence& sequence);

}  // namespace ossa::recon
