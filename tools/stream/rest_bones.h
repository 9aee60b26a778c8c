#pragma once
#include <string>
#include <vector>

#include "tools/stream/unity_humanoid.h"

namespace ossa::stream {

/// A bone of Unity's humanoid that a depth image does not tell of: its name as HumanBodyBones has
/// it, and where it is at rest, as its parent sees it.
struct RestBone {
  std::string name;
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();
};

/// The 34 bones that PoseOf leaves out, for who expects all of HumanBodyBones: upper chest (where
/// the chest is, since the neck's place is told from there), eyes, jaw, and fingers stretched out
/// in the size of the person's hands and head.
std::vector<RestBone> MakeRestBones(const Humanoid& world);

}  // namespace ossa::stream
