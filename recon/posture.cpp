#include "recon/posture.h"

namespace ossa::recon {

BoneLengths BoneLengthsOf(const Posture& posture) {
  BoneLengths lengths{};
  for (size_t i = 1; i < kJointCount; ++i) {
    const auto parent = static_cast<size_t>(kJointParent[i]);
    lengths[i] = (posture.position_m[i] - posture.position_m[parent]).norm();
  }
  return lengths;
}

}  // namespace ossa::recon
