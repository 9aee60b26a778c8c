#pragma once
#include "recon/skeleton_sequence.h"

namespace ossa::recon {

/// Offline, for comparison only: second-order Butterworth low pass run forwards and backwards over
/// every joint (zero phase), anew after an absence. Joints that have no place (HasPlace) come out
/// absent.
SkeletonSequence ButterworthSequence(const SkeletonSequence& sequence, double cutoff_hz = 6.0);

}  // namespace ossa::recon
