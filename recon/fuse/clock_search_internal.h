#pragma once
#include <Eigen/Geometry>
#include <vector>

#include "recon/fuse/joint_track_internal.h"

namespace ossa::recon {

/// One way in which another camera may be placed.
struct CameraGuess {
  Eigen::Isometry3d camera_0_from_other = Eigen::Isometry3d::Identity();
  double clock_offset_s = 0.0;  // added to the other camera's times
  double cost = 0.0;            // the less the better; square metres
};

/// Clock offsets to look at: all `step_s` from low to high.
struct OffsetGrid {
  double low_s = 0.0, high_s = 0.0;
  double step_s = 1.0 / 30;  // a Kinect's frame: by convention
};

/// The offsets at which two tracks, taken for the same person's, agree best: the three best local
/// minima of the mean square left by the best rigid transform, or fewer. Tracks that never overlap
/// long enough have none.
std::vector<CameraGuess> SearchClock(const JointTrack& of_camera_0, const JointTrack& of_other,
                                     const OffsetGrid& grid);

}  // namespace ossa::recon
