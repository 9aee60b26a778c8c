#pragma once
#include "recon/normalise.h"

namespace ossa::recon {

/// The posture with exactly these bone lengths that is nearest to the given one: minimises the
/// weighted sum of squared joint displacements under 19 length constraints (Gauss-Newton with
/// Lagrange multipliers). Weights must be positive; joints of larger weight move less. If a few
/// steps do not converge, because bones are strongly distorted, eq. 4 of Shum & Ho 2012 enforces
/// the rest.
Posture WithBoneLengths(const Posture& posture, const BoneLengths& lengths_m,
                        const JointWeights& weights);

}  // namespace ossa::recon
