#include <algorithm>

#include "recon/methods/bone_projection_internal.h"

namespace ossa::recon {

Posture WithBoneLengths(const Posture& posture, const BoneLengths& lengths_m,
                        const JointWeights& trust) {
  constexpr int kSweeps = 20;
  Posture p = posture;
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    for (size_t i = 1; i < kJointCount; ++i) {
      const auto parent = static_cast<size_t>(kJointParent[i]);
      const Eigen::Vector3d bone = p.position_m[i] - p.position_m[parent];
      const double length = bone.norm();
      if (length < 1e-6) continue;
      const double child = 1.0 / (0.2 + trust[i]);
      const double root = 1.0 / (0.2 + trust[parent]);
      const Eigen::Vector3d error = bone * ((length - lengths_m[i]) / length);
      p.position_m[i] -= error * (child / (child + root));
      p.position_m[parent] += error * (root / (child + root));
    }
  }
  return Retargeted(p, lengths_m);
}

}  // namespace ossa::recon
