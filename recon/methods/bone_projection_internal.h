#pragma once
#include "recon/normalise.h"

namespace ossa::recon {

/// The posture with exactly these bone lengths that lies close to the given one: a few sweeps that
/// move both ends of every bone, trusted joints less, then eq. 4 of Shum & Ho 2012 for what is
/// left.
Posture WithBoneLengths(const Posture& posture, const BoneLengths& lengths_m,
                        const JointWeights& trust);

}  // namespace ossa::recon
