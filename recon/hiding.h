#pragma once
#include <Eigen/Core>

#include "depth/image/depth_frame.h"

namespace ossa::recon {

// Constants: chosen by hand on indoor scenes of validation subjects.

/// What a joint may be moved by to get out of the camera's sight. On eight rendered performances of
/// validation subjects inwards_m was tried from 0 to 6 cm, before_m from 4 to 15.
struct HidingOptions {
  double before_m = 0.08;   // a joint is in the air if every surface around it is this much farther
  double reach_m = 0.4;     // how far across the line of sight a hiding place is looked for
  double inwards_m = 0.03;  // a limb's axis lies this far within its outline
  double skin_m = 0.02;     // and so far behind the surface
};

/// Ours: a joint that the camera does not see is behind something or outside the image. Where the
/// camera looks through it at a surface farther away it cannot be. Returns the nearest place across
/// the line of sight that something hides, or `joint_in_camera` (metres) itself where it is hidden
/// already, where the image cannot tell (its border, no reading) or where nothing is within reach.
Eigen::Vector3d HiddenPlace(const Eigen::Vector3d& joint_in_camera, const depth::DepthFrame& depth,
                            const HidingOptions& options = {});

/// Whether the camera looks through this place at something farther away.
bool IsInTheAir(const Eigen::Vector3d& joint_in_camera, const depth::DepthFrame& depth,
                const HidingOptions& options = {});

}  // namespace ossa::recon
