#pragma once
#include "recon/normalise.h"
#include "recon/posture.h"

namespace ossa::recon {

/// Whether any joints are present (1), but neither HipCenter, Spine nor ShoulderCenter.
bool IsTrunkUnseen(const JointWeights& present);

/// Places each absent joint relative to the nearest present ones along the bones, in either
/// direction, with its offset in `model`; the mean if two are equally near. For bodies without a
/// visible trunk: relative to a root that follows the visible joints, the others would slowly drift
/// away. At least one joint must be `present` (1 or 0).
void PlaceFromPresent(Posture& posture, const JointWeights& present, const Posture& model);

/// Pulls absent joints within reach of the nearest present ones: no bone between them is longer
/// than 1.3 times its length. Joints within reach are unchanged.
void PullIntoReach(Posture& posture, const JointWeights& present, const BoneLengths& lengths_m);

}  // namespace ossa::recon
