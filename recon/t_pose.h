#pragma once
#include <Eigen/Core>

#include "recon/posture.h"

namespace ossa::recon {

/// Direction of the bone that ends in the joint, in a T-pose facing +z: the rest pose of exported
/// files, and of a character before its first target. A unit vector.
Eigen::Vector3d TPoseDirection(size_t joint);

/// A T-pose with these bone lengths, metres, HipCenter at the origin.
Posture BuildTPose(const BoneLengths& lengths_m);

}  // namespace ossa::recon
