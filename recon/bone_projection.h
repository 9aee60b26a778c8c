#pragma once
#include "recon/normalise.h"

namespace ossa::recon {

/// The posture with exactly these bone lengths that lies near the given one: joints move by a least
/// weighted sum of squares (Gauss-Newton on the 19 constraints with Lagrange's multipliers), those
/// with more weight less. Weights must be positive. What a few steps leave open, with bones bent
/// out of all shape, eq. 4 of Shum & Ho 2012 closes.
Posture WithBoneLengths(const Posture& posture, const BoneLengths& lengths_m,
                        const JointWeights& weights);

}  // namespace ossa::recon
