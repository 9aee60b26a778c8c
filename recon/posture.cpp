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

TrackedPosture SidesExchanged(const TrackedPosture& seen) {
  TrackedPosture exchanged = seen;
  for (size_t i = 0; i < kJointCount; ++i) {
    const size_t mirrored = kMirroredJoint[i];
    exchanged.posture.position_m[i] = seen.posture.position_m[mirrored];
    exchanged.state[i] = seen.state[mirrored];
    exchanged.confidence[i] = seen.confidence[mirrored];
  }
  return exchanged;
}

double MeanDistance_m(const Posture& posture, const Posture& target) {
  double sum_m = 0.0;
  int count = 0;
  for (size_t i = 0; i < kJointCount; ++i) {
    if (!target.position_m[i].allFinite()) continue;
    sum_m += (posture.position_m[i] - target.position_m[i]).norm();
    ++count;
  }
  return count == 0 ? 0.0 : sum_m / count;
}

Posture FilledFrom(const Posture& whole, const Posture& seen) {
  Posture filled = seen;
  for (size_t i = 0; i < kJointCount; ++i) {
    if (seen.position_m[i].allFinite()) continue;
    const size_t parent = ParentOf(i);
    filled.position_m[i] = whole.position_m[i];
    if (i > 0) {
      filled.position_m[i] =
          filled.position_m[parent] + whole.position_m[i] - whole.position_m[parent];
    }
  }
  return filled;
}

}  // namespace ossa::recon
