#pragma once
#include "recon/skeleton_sequence.h"

namespace ossa::recon {

/// Median time between the frames of a recording, seconds; 0 for fewer than two frames. Steps of
/// zero are ignored: loggers that poll faster than sensors deliver repeat times.
double MedianStep_s(const SkeletonSequence& sequence);

/// Longest gap between frames to interpolate over: `least_s`, or a frame and a half of a slower
/// recording.
double BridgedGap_s(const SkeletonSequence& sequence, double least_s);

}  // namespace ossa::recon
