#pragma once
#include <Eigen/Core>

#include "recon/posture.h"

namespace ossa::recon {

/// Where the bone that ends in the joint points in a T-pose facing +z: the rest pose of the files
/// that are written, and of a character that waits for its first target. A unit vector.
Eigen::Vector3d TPoseDirection(size_t joint);

/// A T-pose of bones of these lengths, metres, the centre of the hips at the origin.
Posture BuildTPose(const BoneLengths& lengths_m);

}  // namespace ossa::recon
