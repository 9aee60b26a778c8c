#pragma once
#include "recon/skeleton_sequence.h"

namespace ossa::recon {

/// Offline, for comparison only: a second-order Butterworth low pass run forwards and backwards
/// over every joint (zero phase), restarted after absences. Joints without a position (HasPlace)
/// are absent in the result.
SkeletonSequence ButterworthSequence(const SkeletonSequence& sequence, double cutoff_hz = 6.0);

}  // namespace ossa::recon
