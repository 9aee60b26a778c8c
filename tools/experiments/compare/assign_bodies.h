#pragma once
#include <optional>
#include <vector>

#include "tools/experiments/compare/joint_track.h"

namespace ossa::tools {

/// The true people and the bodies of a result at one time.
struct Moment {
  double time_s = 0.0;
  std::vector<std::optional<SparsePosture>> truths;  // by person; empty: unknown at this time
  std::vector<SparsePosture> bodies;
  std::vector<int> ids;  // of the bodies, as in the result
};

/// Each true person takes the nearest body nobody nearer took, so that identities do not matter
/// here (identity switches are the tracker's own table). One posture a person, without joints where
/// none is left.
std::vector<SparsePosture> AssignBodies(const Moment& moment);

/// The rigid transform (no scale) to the truth's space of a result in another one: places alone do
/// not tell there who of several people is whom. Of the transforms that bring one body's way onto
/// one person's it is the one that leaves all bodies nearest to people; the identity where none
/// leaves them nearer, and where there is no choice at any time.
Eigen::Matrix4d FindCommonTransform(const std::vector<Moment>& moments);

void MoveBodies(const Eigen::Matrix4d& transform, std::vector<Moment>& moments);

/// Every joint's place.
SparsePosture Moved(const Eigen::Matrix4d& transform, SparsePosture posture);

}  // namespace ossa::tools
