#pragma once
#include "recon/skeleton_sequence.h"

namespace ossa::recon {

/// Median time between the frames of a recording, seconds; 0 of fewer than two frames. Loggers that
/// ask faster than sensors answer say each time twice: steps of no time are not counted.
double MedianStep_s(const SkeletonSequence& sequence);

/// Gaps between frames that are bridged on the line between: `least_s`, or a frame and a half of a
/// recording that is slower.
double BridgedGap_s(const SkeletonSequence& sequence, double least_s);

}  // namespace ossa::recon
