#pragma once
#include "recon/fit/posed_surface.h"

namespace ossa::recon {

/// An initial pose of the mean body near the joints (camera space, metres; all finite), by inverse
/// kinematics: the trunk from hips and shoulders, then each limb segment aimed at its joint with
/// the smallest twist.
SurfacePose PoseFromJoints(const BodySurface& surface, const Posture& joints_m);

}  // namespace ossa::recon
