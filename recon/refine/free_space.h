#pragma once
#include <Eigen/Core>

#include "depth/image/depth_frame.h"

namespace ossa::recon {

// Constants: chosen on eight rendered performances of validation subjects.

/// How far a joint may be moved to satisfy the free-space constraint, metres, > 0. On eight
/// rendered performances of validation subjects inwards_m was tried from 0 to 6 cm, before_m from 4
/// to 15.
struct FreeSpaceOptions {
  double before_m = 0.08;   // a joint is in free space if every surface around is this much farther
  double reach_m = 0.4;     // how far across the line of sight a hidden place is searched
  double inwards_m = 0.03;  // a limb's axis lies this far within its silhouette
  double skin_m = 0.02;     // and so far behind the surface
};

/// Ours, the free-space constraint (as occupancy grids carve space, Moravec and Elfes 1985): a
/// joint that the camera does not see is behind something or outside the image. Where the camera
/// sees through it to a surface farther away it cannot be. Returns the nearest place across the
/// line of sight that something hides, or `joint_in_camera` (metres) itself where it is hidden
/// already, where the image cannot tell (its border, no reading) or where nothing is within reach.
Eigen::Vector3d MoveOutOfFreeSpace(const Eigen::Vector3d& joint_in_camera,
                                   const depth::DepthFrame& depth,
                                   const FreeSpaceOptions& options = {});

/// Whether the camera sees through this place to something farther away.
bool IsInFreeSpace(const Eigen::Vector3d& joint_in_camera, const depth::DepthFrame& depth,
                   const FreeSpaceOptions& options = {});

}  // namespace ossa::recon
