#pragma once
#include <Eigen/Core>
#include <vector>

#include "recon/skeleton_sequence.h"

namespace ossa::recon {

/// Where a camera saw a body's joints at one time: those that it tracked.
struct SeenJoints {
  JointArray<Eigen::Vector3d> position_m;  // the camera's space
  JointArray<double> weight{};             // the joint's confidence, [0, 1]; 0: not tracked
};

/// One body of one camera over time, in order of time.
struct JointTrack {
  int id = 0;
  std::vector<double> time_s;
  std::vector<SeenJoints> seen;
  double max_gap_s = 0.0;  // between moments that are taken for one stretch

  double length_s() const { return time_s.empty() ? 0.0 : time_s.back() - time_s.front(); }
};

/// The tracks of all bodies of a recording, in order of their ids. Moments at which none of a
/// body's joints is tracked are left out.
std::vector<JointTrack> CollectJointTracks(const SkeletonSequence& sequence);

/// The joints at a time between two moments at which the body was seen, at most max_gap_s apart:
/// positions on the line between, weights the lesser. False, and `seen` means nothing, elsewhere.
bool InterpolateJoints(const JointTrack& track, double time_s, SeenJoints& seen);

/// Mean distance of the joints that both have, metres, each weighed by the lesser weight; infinite
/// where these are fewer than `least_joints`.
double MeanJointDistance_m(const SeenJoints& a, const SeenJoints& b, int least_joints);

}  // namespace ossa::recon
