#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "recon/bone_projection.h"

namespace ossa::recon {
namespace {

constexpr int kBones = kJointCount - 1;
using BoneMatrix = Eigen::Matrix<double, kBones, kBones>;
using BoneVector = Eigen::Matrix<double, kBones, 1>;

constexpr Eigen::Index RowOf(size_t bone) { return static_cast<Eigen::Index>(bone - 1); }

struct Constraints {
  JointArray<Eigen::Vector3d> direction;  // unit vector of the bone that ends in the joint
  BoneVector too_long_m;                  // entry i - 1: bone i
};

Constraints LinearisedConstraints(const Posture& p, const BoneLengths& lengths_m) {
  Constraints c;
  for (size_t i = 1; i < kJointCount; ++i) {
    const Eigen::Vector3d bone = p.position_m[i] - p.position_m[ParentOf(i)];
    const double length = std::max(bone.norm(), 1e-9);
    c.direction[i] = bone / length;
    c.too_long_m[RowOf(i)] = length - lengths_m[i];
  }
  return c;
}

/// J W^-1 J'. Bones that share a joint are coupled.
BoneMatrix Coupling(const Constraints& c, const JointWeights& give) {
  BoneMatrix a = BoneMatrix::Zero();
  for (size_t bone = 1; bone < kJointCount; ++bone) {
    const size_t parent = ParentOf(bone);
    const Eigen::Index row = RowOf(bone);
    a(row, row) = give[bone] + give[parent];
    for (size_t other = bone + 1; other < kJointCount; ++other) {
      double shared = 0.0;
      if (ParentOf(other) == bone) shared = -give[bone];
      if (ParentOf(other) == parent) shared = give[parent];
      if (shared == 0.0) continue;
      const Eigen::Index column = RowOf(other);
      a(row, column) = a(column, row) = shared * c.direction[bone].dot(c.direction[other]);
    }
  }
  return a;
}

bool HasDirections(const Posture& p) {
  for (size_t i = 1; i < kJointCount; ++i) {
    const auto parent = ParentOf(i);
    if (!((p.position_m[i] - p.position_m[parent]).norm() > 1e-3)) return false;
  }
  return true;
}

}  // namespace

Posture WithBoneLengths(const Posture& posture, const BoneLengths& lengths_m,
                        const JointWeights& weights) {
  constexpr int kMostSteps = 8;      // by hand
  constexpr double kExact_m = 1e-9;  // rounding
  JointWeights give;
  for (size_t i = 0; i < kJointCount; ++i) give[i] = 1.0 / weights[i];
  Posture p = HasDirections(posture) ? posture : Retargeted(posture, lengths_m);
  for (int step = 0; step < kMostSteps; ++step) {
    const Constraints c = LinearisedConstraints(p, lengths_m);
    if (c.too_long_m.cwiseAbs().maxCoeff() < kExact_m) return p;
    const BoneVector pull = Coupling(c, give).llt().solve(c.too_long_m);
    for (size_t i = 1; i < kJointCount; ++i) {
      const auto parent = ParentOf(i);
      const Eigen::Vector3d force = pull[RowOf(i)] * c.direction[i];
      p.position_m[i] -= give[i] * force;
      p.position_m[parent] += give[parent] * force;
    }
  }
  return Retargeted(p, lengths_m);
}

}  // namespace ossa::recon
