#pragma once
#include "recon/methods/best/frame_state_internal.h"
#include "recon/methods/best/trust_internal.h"

namespace ossa::recon {

/// Stage 6 of `best`: gives bones their lengths while moving trusted joints least. The far joints
/// of a limb move more: sensors measure them worst, and a wrong hand must not pull its elbow along.
/// `limb_firmness`: weight of a limb joint relative to its parent's, in (0, 1].
Posture ImposeBones(const Posture& posture, const BoneLengths& lengths_m, const FrameState& frame,
                    const SensorTraits& sensor, double limb_firmness);

}  // namespace ossa::recon
