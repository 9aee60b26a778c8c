#pragma once
#include <string>
#include <vector>

#include "tools/stream/unity_humanoid.h"

namespace ossa::stream {

/// A bone of Unity's humanoid that is not estimated: its name in HumanBodyBones, and its rest
/// position in its parent's space, metres.
struct RestBone {
  std::string name;
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();
};

/// The 34 bones of HumanBodyBones that ComputePose() leaves out: upper chest (at the chest, to
/// which the neck's position is relative), eyes, jaw, and stretched fingers, in the size of the
/// person's hands and head.
std::vector<RestBone> MakeRestBones(const Humanoid& world);

}  // namespace ossa::stream
