#pragma once
#include <span>
#include <string>

#include "recon/fuse/extrinsics.h"
#include "recon/skeleton_sequence.h"

namespace ossa::recon {

/// Options for estimating a camera's pose from skeletons.
struct EstimateExtrinsicsOptions {
  /// Largest clock offset relative to equal clocks or equal start times, seconds, >= 0; by hand:
  /// two programs started by hand.
  double max_clock_offset_s = 5.0;
};

/// A camera's estimated pose and clock offset, and how well the skeletons agree.
struct CameraEstimate {
  CameraExtrinsics camera;      // without its name
  double disagreement_m = 0.0;  // median distance of the joints that both cameras track
  double common_s = 0.0;        // seconds in which both cameras see people
};

/// Estimates the pose of a camera from moving bodies that it and camera 0 both see; ids may differ,
/// and either camera may see additional people. For each pair of bodies and each clock offset on a
/// grid the rigid transform has a closed form (Kabsch 1976). Of the best candidates the one that
/// explains most of all bodies is refined with robust weights (Geman and McClure 1987). If both
/// recordings have floors, their normals have a small weight. Tracked joints are weighted by
/// confidence. Throws InputError that names other.source if the data do not determine the pose: no
/// common people, no motion, repetitive motion, or no transform that aligns the joints.
CameraEstimate EstimateCamera(const SkeletonSequence& camera_0, const SkeletonSequence& other,
                              const EstimateExtrinsicsOptions& options = {});

}  // namespace ossa::recon
