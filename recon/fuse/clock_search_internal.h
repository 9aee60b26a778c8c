#pragma once
#include <Eigen/Geometry>
#include <vector>

#include "recon/fuse/joint_track_internal.h"

namespace ossa::recon {

/// A candidate pose and clock offset of the other camera.
struct CameraGuess {
  Eigen::Isometry3d camera_0_from_other = Eigen::Isometry3d::Identity();
  double clock_offset_s = 0.0;  // added to the other camera's times
  double cost = 0.0;            // square metres; lower is better
};

/// Clock offsets to try: from low to high in steps of `step_s`.
struct OffsetGrid {
  double low_s = 0.0, high_s = 0.0;
  double step_s = 1.0 / 30;  // a Kinect's frame: by convention
};

/// The clock offsets at which two tracks, assumed to be the same person's, agree best: up to three
/// local minima of the mean squared residual after the best rigid transform. Empty if the tracks
/// never overlap long enough.
std::vector<CameraGuess> SearchClock(const JointTrack& of_camera_0, const JointTrack& of_other,
                                     const OffsetGrid& grid);

}  // namespace ossa::recon
