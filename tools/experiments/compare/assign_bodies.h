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

/// Assigns bodies to true people, nearest pairs first, regardless of ids (identity switches are
/// counted elsewhere). One posture per person, without joints if no body is left.
std::vector<SparsePosture> AssignBodies(const Moment& moment);

/// The rigid transform (no scale) from the result's space to the truth's, for several people.
/// Candidates align the path of one body with that of one person; the best one brings all bodies
/// nearest to people. The identity if no candidate is better, and if there is never more than one
/// assignment.
Eigen::Matrix4d FindCommonTransform(const std::vector<Moment>& moments);

void MoveBodies(const Eigen::Matrix4d& transform, std::vector<Moment>& moments);

/// Positions of all joints.
SparsePosture Moved(const Eigen::Matrix4d& transform, SparsePosture posture);

}  // namespace ossa::tools
