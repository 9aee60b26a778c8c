#pragma once
#include <array>

#include "recon/posture.h"

namespace ossa::physics {

/// The posture with the given bone lengths that is nearest to `posture`, joint i weighing
/// `weight[i]` >= 0. Departure from Shum & Ho 2012 eqs. 3-4 (recon::Retargeted): those let a hand
/// take the sum of all length errors from the hips on, right for people of another size; for a
/// character of the user's own size the errors are better shared.
/// Gauss-Seidel over the bones (as in position-based dynamics); lengths are exact afterwards.
recon::Posture FitBoneLengths(const recon::Posture& posture, const recon::BoneLengths& lengths,
                              const recon::JointArray<double>& weight, int iterations = 8);

}  // namespace ossa::physics
