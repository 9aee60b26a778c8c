#pragma once
#include <array>

#include "recon/posture.h"

namespace ossa::physics {

/// The posture with the given bone lengths nearest to `posture`, with joint i weighted by
/// `weight[i]` >= 0. Departure from Shum & Ho 2012 eqs. 3-4 (recon::Retargeted): these accumulate
/// length errors from the hips to the hand, which is right for people of another size; for a
/// character of the user's own size errors are better distributed. Gauss-Seidel over the bones (as
/// in position-based dynamics); lengths are exact afterwards.
recon::Posture FitBoneLengths(const recon::Posture& posture, const recon::BoneLengths& lengths,
                              const recon::JointArray<double>& weight, int iterations = 8);

}  // namespace ossa::physics
