#include "physics/fit_bone_lengths.h"

#include <algorithm>

#include "recon/normalise.h"

namespace ossa::physics {
namespace {

using Eigen::Vector3d;
using recon::kJointCount;
using recon::Posture;

constexpr double kTinyLength_m = 1e-6;  // a bound, against division by 0

}  // namespace

Posture FitBoneLengths(const Posture& posture, const recon::BoneLengths& lengths,
                       const recon::JointArray<double>& weight, int iterations) {
  Posture fitted = posture;
  for (int round = 0; round < iterations; ++round) {
    for (size_t i = 1; i < kJointCount; ++i) {
      const auto parent = recon::ParentOf(i);
      const Vector3d bone = fitted.position_m[i] - fitted.position_m[parent];
      const double length = bone.norm();
      if (length < kTinyLength_m) continue;
      // Each end moves in inverse proportion to its weight.
      const double wi = std::max(weight[i], 1e-3), wp = std::max(weight[parent], 1e-3);
      const Vector3d excess = bone * ((length - lengths[i]) / length);
      fitted.position_m[i] -= excess * (wp / (wi + wp));
      fitted.position_m[parent] += excess * (wi / (wi + wp));
    }
  }
  return recon::Retargeted(fitted, lengths);
}

}  // namespace ossa::physics
