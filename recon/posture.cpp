#include "recon/posture.h"

namespace ossa::recon {

BoneLengths MeasureBoneLengths(const Posture& posture) {
  BoneLengths lengths{};
  for (size_t i = 1; i < kJointCount; ++i) {
    const auto parent = ParentOf(i);
    lengths[i] = (posture.position_m[i] - posture.position_m[parent]).norm();
  }
  return lengths;
}

}  // namespace ossa::recon
