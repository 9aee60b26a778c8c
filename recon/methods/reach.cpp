#include <algorithm>
#include <limits>
#include <vector>

#include "recon/methods/reach_internal.h"

namespace ossa::recon {
namespace {

using Eigen::Vector3d;

/// Bone lengths of sensors vary by up to a third during a movement (measured, see trust in `best`);
/// no unit: a ratio.
constexpr double kStretch = 1.3;

std::vector<size_t> FindNeighbours(size_t joint) {
  std::vector<size_t> neighbours;
  for (size_t other = 0; other < kJointCount; ++other) {
    if (kJointParent[other] == static_cast<int>(joint) ||
        kJointParent[joint] == static_cast<int>(other)) {
      neighbours.push_back(other);
    }
  }
  return neighbours;
}

/// Number of bones from each joint to the nearest present one.
JointArray<int> CountBones(const JointWeights& present) {
  constexpr int kFar = std::numeric_limits<int>::max();
  JointArray<int> bones;
  std::vector<size_t> queue;
  for (size_t i = 0; i < kJointCount; ++i) {
    bones[i] = present[i] > 0.0 ? 0 : kFar;
    if (bones[i] == 0) queue.push_back(i);
  }
  for (size_t next = 0; next < queue.size(); ++next) {
    for (const size_t other : FindNeighbours(queue[next])) {
      if (bones[other] != kFar) continue;
      bones[other] = bones[queue[next]] + 1;
      queue.push_back(other);
    }
  }
  return bones;
}

/// Calls `place(joint, nearer)` for absent joints in order of their distance to present ones;
/// `nearer` are the neighbours that are one bone closer.
template <typename Place>
void ForEachAbsent(const JointWeights& present, const Place& place) {
  const auto bones = CountBones(present);
  for (int distance = 1; distance < kJointCount; ++distance) {
    for (size_t joint = 0; joint < kJointCount; ++joint) {
      if (bones[joint] != distance) continue;
      std::vector<size_t> nearer;
      for (const size_t other : FindNeighbours(joint)) {
        if (bones[other] == distance - 1) nearer.push_back(other);
      }
      place(joint, nearer);
    }
  }
}

}  // namespace

bool IsTrunkUnseen(const JointWeights& present) {
  const auto is_present = [&](Joint joint) { return present[joint] > 0.0; };
  if (is_present(Joint::kHipCenter) || is_present(Joint::kSpine) ||
      is_present(Joint::kShoulderCenter)) {
    return false;
  }
  return std::any_of(present.begin(), present.end(), [](double weight) { return weight > 0.0; });
}

void PlaceFromPresent(Posture& posture, const JointWeights& present, const Posture& model) {
  ForEachAbsent(present, [&](size_t joint, const std::vector<size_t>& nearer) {
    Vector3d sum = Vector3d::Zero();
    for (const size_t other : nearer) {
      sum += posture.position_m[other] + model.position_m[joint] - model.position_m[other];
    }
    posture.position_m[joint] = sum / static_cast<double>(nearer.size());
  });
}

void PullIntoReach(Posture& posture, const JointWeights& present, const BoneLengths& lengths_m) {
  ForEachAbsent(present, [&](size_t joint, const std::vector<size_t>& nearer) {
    for (const size_t other : nearer) {
      const double reach_m = kStretch * lengths_m[std::max(joint, other)];  // bone of the child
      const Vector3d bone = posture.position_m[joint] - posture.position_m[other];
      if (!(bone.norm() > reach_m)) continue;
      posture.position_m[joint] = posture.position_m[other] + reach_m * bone.normalized();
    }
  });
}

}  // namespace ossa::recon
