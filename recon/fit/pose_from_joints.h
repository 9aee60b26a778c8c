#pragma once
#include "recon/fit/posed_surface.h"

namespace ossa::recon {

/// A pose of the mean body near to joints (camera space, metres; all finite): the trunk by hips and
/// shoulders, then each limb's segments aimed at their joints with the least twist. Inverse
/// kinematics to start from, not a fit.
SurfacePose PoseFromJoints(const BodySurface& surface, const Posture& joints_m);

}  // namespace ossa::recon
