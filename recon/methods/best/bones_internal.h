#pragma once
#include "recon/methods/best/frame_state_internal.h"
#include "recon/methods/best/trust_internal.h"

namespace ossa::recon {

/// Stage 6 of `best`: the person's bones get their lengths, which moves the trusted joints least.
/// Of a limb the far joints give way: sensors see them worst, and a hand that is off must not pull
/// its elbow along. `limb_firmness`: weight of a limb's joint over its parent's, in (0, 1].
Posture ImposeBones(const Posture& posture, const BoneLengths& lengths_m, const FrameState& frame,
                    const SensorTraits& sensor, double limb_firmness);

}  // namespace ossa::recon
