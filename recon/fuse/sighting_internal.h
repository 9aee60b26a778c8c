#pragma once
#include <Eigen/Geometry>
#include <optional>
#include <span>
#include <vector>

#include "recon/fuse/extrinsics.h"
#include "recon/skeleton_sequence.h"

namespace ossa::recon {

/// A body as one camera sees it at one of camera 0's times, brought to camera 0's space.
struct BodySighting {
  size_t camera = 0;
  BodyRecord body;  // the camera's own id; positions, orientations in camera 0's space
  JointArray<Eigen::Matrix3d> covariance_m2;  // of each joint that is there, camera 0's axes
};

/// One body of one camera over time: the records of a sequence that lives longer.
struct BodyTrack {
  int id = 0;
  std::vector<double> time_s;
  std::vector<const BodyRecord*> bodies;
  double max_gap_s = 0.0;  // between moments that are taken for one stretch
};

/// Tracks of all bodies, in order of their ids; `max_gap_s`, or a frame and a half of a recording
/// that is slower, are bridged.
std::vector<BodyTrack> CollectBodyTracks(const SkeletonSequence& sequence, double max_gap_s);

/// The body at a time. Between two moments at most the track's max_gap_s apart joints lie on the
/// line between and are what the lesser of the two says of them; else the body is where it was
/// within five milliseconds, in which nobody moves by more than a centimetre. None elsewhere:
/// nothing is extrapolated.
std::optional<BodyRecord> BodyAt(const BodyTrack& track, double time_s);

/// A camera's body in camera 0's space. How sure a joint is follows from its own standard
/// deviations, where it has them; else a depth camera is surer across the ray than along it, and
/// less sure of a joint of little confidence or reliability.
BodySighting MakeSighting(size_t camera, BodyRecord body,
                          const Eigen::Isometry3d& camera_0_from_camera);

/// Mean distance of the joints that both track, metres; of those that both have a place for, where
/// fewer than three are tracked; infinite where there are none.
double MeanDistance_m(const BodyRecord& a, const BodyRecord& b);

}  // namespace ossa::recon
