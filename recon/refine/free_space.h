#pragma once
#include <Eigen/Core>

#include "depth/image/depth_frame.h"

namespace ossa::recon {

// Constants: chosen on eight rendered performances of validation subjects.

/// Limits of moving a joint to satisfy the free-space constraint, metres, > 0. Chosen on eight
/// rendered sequences of validation subjects: inwards_m was varied from 0 to 6 cm, before_m from 4
/// to 15.
struct FreeSpaceOptions {
  double before_m = 0.08;   // free space: every surface around is this much farther away
  double reach_m = 0.4;     // search radius perpendicular to the line of sight
  double inwards_m = 0.03;  // distance of a limb's axis from its silhouette
  double skin_m = 0.02;     // ... and behind its surface
};

/// Ours, the free-space constraint (as occupancy grids carve space, Moravec and Elfes 1985): an
/// unseen joint is behind something or outside the image. It cannot be where the camera sees a
/// surface farther away. Returns the nearest hidden position perpendicular to the line of sight, or
/// `joint_in_camera` (metres) itself if it is already hidden, if the image cannot tell (its border,
/// no reading), or if nothing is within reach.
Eigen::Vector3d MoveOutOfFreeSpace(const Eigen::Vector3d& joint_in_camera,
                                   const depth::DepthFrame& depth,
                                   const FreeSpaceOptions& options = {});

/// Whether the camera sees past this position to something farther away.
bool IsInFreeSpace(const Eigen::Vector3d& joint_in_camera, const depth::DepthFrame& depth,
                   const FreeSpaceOptions& options = {});

}  // namespace ossa::recon
