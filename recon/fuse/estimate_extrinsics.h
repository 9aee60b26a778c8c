#pragma once
#include <span>
#include <string>

#include "recon/fuse/extrinsics.h"
#include "recon/skeleton_sequence.h"

namespace ossa::recon {

/// How cameras are found by the people in their skeletons.
struct EstimateExtrinsicsOptions {
  /// Clocks may differ by so much more than the starts of the recordings do, or than nothing,
  /// seconds, >= 0; by hand: two programs started by hand.
  double max_clock_offset_s = 5.0;
};

/// Where another camera is and what its clock says, and how well skeletons agree then.
struct CameraEstimate {
  CameraExtrinsics camera;      // without its name
  double disagreement_m = 0.0;  // median distance of the joints that both cameras track
  double common_s = 0.0;        // seconds in which both cameras see somebody
};

/// Finds one camera by the bodies that it and camera 0 both see moving; ids may differ, and each
/// may see people whom the other does not. For each pair of bodies and each clock offset on a grid
/// the rigid transform between them is a closed form (Kabsch 1976); of the best the one that
/// explains most of all bodies is refined with robust weights (Geman and McClure 1987). Where both
/// recordings have floors, their normals count a little. Joints that are tracked count by their
/// confidence. Throws InputError that names other.source where there is too little to go by: nobody
/// in both, nobody who moves, motion that repeats, or joints that no transform brings together.
CameraEstimate EstimateCamera(const SkeletonSequence& camera_0, const SkeletonSequence& other,
                              const EstimateExtrinsicsOptions& options = {});

}  // namespace ossa::recon
