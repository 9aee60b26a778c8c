#pragma once
#include <Eigen/Geometry>
#include <optional>
#include <span>
#include <vector>

#include "recon/fuse/extrinsics.h"
#include "recon/skeleton_sequence.h"

namespace ossa::recon {

/// A body seen by one camera at one of camera 0's times, in camera 0's space.
struct BodySighting {
  size_t camera = 0;
  BodyRecord body;  // the camera's own id; positions, orientations in camera 0's space
  JointArray<Eigen::Matrix3d> covariance_m2;  // covariance of each present joint, camera 0's axes
};

/// A body over time, as seen by one camera: pointers into a sequence that outlives it.
struct BodyTrack {
  int id = 0;
  std::vector<double> time_s;
  std::vector<const BodyRecord*> bodies;
  double max_gap_s = 0.0;  // longest gap that is interpolated
};

/// Tracks of all bodies, in order of ids; bridges gaps of `max_gap_s`, or a frame and a half of a
/// slower recording.
std::vector<BodyTrack> CollectBodyTracks(const SkeletonSequence& sequence, double max_gap_s);

/// The body at a time: interpolated linearly between two samples at most the track's max_gap_s
/// apart, with the lower state and confidence of the two; else the nearest sample within five
/// milliseconds, in which nobody moves by more than a centimetre. None elsewhere: nothing is
/// extrapolated.
std::optional<BodyRecord> BodyAt(const BodyTrack& track, double time_s);

/// A camera's body in camera 0's space. The covariance of a joint comes from its own standard
/// deviations, if it has them; otherwise depth cameras are more accurate across the ray than along
/// it, and joints of low confidence or reliability are less accurate.
BodySighting MakeSighting(size_t camera, BodyRecord body,
                          const Eigen::Isometry3d& camera_0_from_camera);

/// Mean distance of the joints that both track, metres; of joints with a position in both, if fewer
/// than three are tracked; infinite if there are none.
double MeanDistance_m(const BodyRecord& a, const BodyRecord& b);

}  // namespace ossa::recon
