#pragma once
#include "recon/normalise.h"
#include "recon/posture.h"

namespace ossa::recon {

/// Whether joints are present (1, not 0), but neither HipCenter, Spine nor ShoulderCenter.
bool IsTrunkUnseen(const JointWeights& present);

/// Places every absent joint from the nearest present ones along the bones, whichever way these go:
/// as it lies to them in `model`, the middle where two are as near. Of a body whose trunk is not
/// seen: from a root that follows the joints seen it would drift away from them, a little a frame.
/// `present` (1 or 0) must hold for one joint at least.
void PlaceFromPresent(Posture& posture, const JointWeights& present, const Posture& model);

/// Pulls absent joints into the reach of the nearest present ones: no bone on the way is longer
/// than 1.3 times its length. What is in reach stays.
void PullIntoReach(Posture& posture, const JointWeights& present, const BoneLengths& lengths_m);

}  // namespace ossa::recon
