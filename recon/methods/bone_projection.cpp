#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "recon/methods/bone_projection.h"

namespace ossa::recon {
namespace {

constexpr int kBones = kJointCount - 1;
using BoneMatrix = Eigen::Matrix<double, kBones, kBones>;
using BoneVector = Eigen::Matrix<double, kBones, 1>;

struct Constraints {
  std::array<Eigen::Vector3d, kJointCount> direction;  // of the bone that ends in the joint
  BoneVector too_long_m;                               // entry i - 1: bone i
};

Constraints ConstraintsOf(const Posture& p, const BoneLengths& lengths_m) {
  Constraints c;
  for (size_t i = 1; i < kJointCount; ++i) {
    const Eigen::Vector3d bone =
        p.position_m[i] - p.position_m[static_cast<size_t>(kJointParent[i])];
    const double length = std::max(bone.norm(), 1e-9);
    c.direction[i] = bone / length;
    c.too_long_m[static_cast<Eigen::Index>(i - 1)] = length - lengths_m[i];
  }
  return c;
}

/// J W^-1 J': two bones are coupled by the joints they share.
BoneMatrix Coupling(const Constraints& c, const JointWeights& give) {
  BoneMatrix a = BoneMatrix::Zero();
  for (int i = 1; i < kJointCount; ++i) {
    const auto bone = static_cast<size_t>(i);
    const auto parent = static_cast<size_t>(kJointParent[bone]);
    a(i - 1, i - 1) = give[bone] + give[parent];
    for (int k = i + 1; k < kJointCount; ++k) {
      const auto other = static_cast<size_t>(k);
      double shared = 0.0;
      if (kJointParent[other] == i) shared = -give[bone];
      if (kJointParent[other] == kJointParent[bone]) shared = give[parent];
      if (shared == 0.0) continue;
      a(i - 1, k - 1) = a(k - 1, i - 1) = shared * c.direction[bone].dot(c.direction[other]);
    }
  }
  return a;
}

bool HasDirections(const Posture& p) {
  for (size_t i = 1; i < kJointCount; ++i) {
    const auto parent = static_cast<size_t>(kJointParent[i]);
    if (!((p.position_m[i] - p.position_m[parent]).norm() > 1e-3)) return false;
  }
  return true;
}

}  // namespace

Posture WithBoneLengths(const Posture& posture, const BoneLengths& lengths_m,
                        const JointWeights& weights) {
  constexpr int kMostSteps = 8;
  constexpr double kExact_m = 1e-9;
  JointWeights give;
  for (size_t i = 0; i < kJointCount; ++i) give[i] = 1.0 / weights[i];
  Posture p = HasDirections(posture) ? posture : Retargeted(posture, lengths_m);
  for (int step = 0; step < kMostSteps; ++step) {
    const Constraints c = ConstraintsOf(p, lengths_m);
    if (c.too_long_m.cwiseAbs().maxCoeff() < kExact_m) return p;
    const BoneVector pull = Coupling(c, give).llt().solve(c.too_long_m);
    for (size_t i = 1; i < kJointCount; ++i) {
      const auto parent = static_cast<size_t>(kJointParent[i]);
      const Eigen::Vector3d force = pull[static_cast<Eigen::Index>(i - 1)] * c.direction[i];
      p.position_m[i] -= give[i] * force;
      p.position_m[parent] += give[parent] * force;
    }
  }
  return Retargeted(p, lengths_m);
}

}  // namespace ossa::recon
