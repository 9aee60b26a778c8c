#pragma once
#include <Eigen/Core>
#include <array>

#include "recon/posture.h"

namespace ossa::recon {

/// One weight per joint.
using JointWeights = JointArray<double>;

/// The standard adult (1.66 m) standing with arms lowered to the sides, facing +z, left = +x, feet
/// on y = 0: the joints of StandardPosture(RigPose{}). Databases and Gaussian processes retarget
/// everyone to its bone lengths.
const Posture& StandardStance();
/// Bone lengths of the standard body, metres, in the order of the joints they end in.
const BoneLengths& StandardBoneLengths();

/// Position and heading of a person: camera = root + Ry(yaw) * normalised. A normalised person
/// faces +z with the left side at +x, HipCenter at the origin.
struct Placement {
  Eigen::Vector3d root_m = Eigen::Vector3d::Zero();  // HipCenter in camera space
  double yaw_rad = 0.0;                              // about y; pi faces the camera
};

/// Placement of a posture in camera space. The heading is that of the hip line and the shoulder
/// line, each weighted by its joints' weights; `previous_yaw_rad` if neither determines it.
Placement EstimatePlacement(const Posture& in_camera, const JointWeights& weights,
                            double previous_yaw_rad);

/// Removes global translation and the rotation about the vertical (Shum & Ho 2012 sec. 5.1).
Posture Normalised(const Posture& in_camera, const Placement& camera_from_normalised);
/// Inverse of Normalised().
Posture Placed(const Posture& normalised, const Placement& camera_from_normalised);

/// Mirrors a normalised posture at x = 0 and exchanges left and right.
Posture Mirrored(const Posture& normalised);

/// Every position multiplied by one factor.
Posture Scaled(const Posture& posture, double factor);

/// Shum & Ho 2012 eqs. 3-4: sets the bone lengths and keeps all directions and the root. Bones
/// without direction (zero length, not finite) get that of the standard stance.
Posture Retargeted(const Posture& posture, const BoneLengths& lengths_m);

/// The standard lengths multiplied by one factor.
BoneLengths ScaledBoneLengths(double scale);

/// Size of a person relative to the standard body: the weighted median of the ratios of bone
/// lengths, bounded to statures of 0.9 m to 2.2 m; 1 if no bone has weight.
double EstimateBodyScale(const BoneLengths& lengths_m, const JointWeights& weights);

}  // namespace ossa::recon
