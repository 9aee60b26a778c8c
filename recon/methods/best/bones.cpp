#include "recon/bone_projection.h"
#include "recon/methods/best/bones_internal.h"

namespace ossa::recon {

Posture ImposeBones(const Posture& posture, const BoneLengths& lengths_m, const FrameState& frame,
                    const SensorTraits& sensor, double limb_firmness) {
  constexpr double kLeast = 0.2;  // weight at zero trust; by hand
  JointWeights firm, weights;
  for (size_t i = 0; i < kJointCount; ++i) {
    firm[i] = IsInLimb(i) ? limb_firmness * firm[ParentOf(i)] : 1.0;
    weights[i] = (IsInTrunk(i) ? sensor.trunk_firmness : firm[i]) * (kLeast + frame.trust[i]);
  }
  return WithBoneLengths(posture, lengths_m, weights);
}

}  // namespace ossa::recon
