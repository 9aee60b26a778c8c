#pragma once
#include <Eigen/Core>
#include <vector>

#include "recon/skeleton_sequence.h"

namespace ossa::recon {

/// The tracked joints of a body at one time, as seen by one camera.
struct SeenJoints {
  JointArray<Eigen::Vector3d> position_m;  // in the camera's space
  JointArray<double> weight{};             // the joint's confidence, [0, 1]; 0: not tracked
};

/// A body's joints over time, as seen by one camera, in order of time.
struct JointTrack {
  int id = 0;
  std::vector<double> time_s;
  std::vector<SeenJoints> seen;
  double max_gap_s = 0.0;  // longest gap that is interpolated

  double length_s() const { return time_s.empty() ? 0.0 : time_s.back() - time_s.front(); }
};

/// The tracks of all bodies of a recording, in order of ids. Frames without tracked joints are left
/// out.
std::vector<JointTrack> CollectJointTracks(const SkeletonSequence& sequence);

/// Interpolates the joints linearly between two samples at most max_gap_s apart; weights are the
/// smaller ones. Returns false, with `seen` undefined, if there are none.
bool InterpolateJoints(const JointTrack& track, double time_s, SeenJoints& seen);

/// Mean distance of common joints, metres, weighted by the smaller weight; infinite if they are
/// fewer than `least_joints`.
double MeanJointDistance_m(const SeenJoints& a, const SeenJoints& b, int least_joints);

}  // namespace ossa::recon
