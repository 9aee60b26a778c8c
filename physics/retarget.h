#pragma once
#include <array>

#include "recon/posture.h"

namespace ossa::physics {

/// Shum & Ho 2012, eqs. 3-4: the posture with the character's bone lengths, each bone keeping its
/// direction, from the root outwards. For people of a quite different size. A bone without a
/// direction (zero or non-finite) points as its parent does.
recon::Posture RetargetByDirections(const recon::Posture& posture,
                                    const recon::BoneLengths& lengths);

/// The posture with the given bone lengths that is nearest to `posture`, joint i weighing
/// `weight[i]` >= 0. Departure from eqs. 3-4: those let a hand take the sum of all length errors
/// from the hips on; for a character of the user's own size the errors are better shared.
/// Gauss-Seidel over the bones (as in position-based dynamics); lengths are exact afterwards.
recon::Posture FitBoneLengths(const recon::Posture& posture, const recon::BoneLengths& lengths,
                              const std::array<double, recon::kJointCount>& weight,
                              int iterations = 8);

}  // namespace ossa::physics
