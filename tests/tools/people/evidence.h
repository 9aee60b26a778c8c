#pragma once
#include <numeric>

#include "recon/posture.h"
#include "tools/people/forest_evidence.h"

namespace ossa::people {

inline JointTargets OneTargetPerJoint() {
  JointTargets targets;
  std::iota(targets.begin(), targets.end(), 0);
  return targets;
}

/// Evidence with these joints as confident proposals.
inline ForestEvidence MakeSureEvidence(const recon::Posture& joints) {
  ForestEvidence evidence;
  for (const Eigen::Vector3d& joint_m : joints.position_m) {
    forest::Proposal proposal;
    proposal.position_m = joint_m;
    proposal.confidence = 1;
    evidence.proposals.push_back({proposal});
  }
  return evidence;
}

}  // namespace ossa::people
