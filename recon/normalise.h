#pragma once
#include <Eigen/Core>
#include <array>

#include "recon/posture.h"

namespace ossa::recon {

/// Joints as the rest of recon weighs them: one value per Joint.
using JointWeights = JointArray<double>;

/// The standard adult (1.66 m) standing with arms lowered to the sides, facing +z, left = +x, feet
/// on y = 0: the joints of StandardPosture(RigPose{}). Its bones are the standard size to which
/// databases and Gaussian processes retarget everyone.
const Posture& StandardStance();
const BoneLengths& StandardBoneLengths();

/// Where a person stands and which way the person faces. camera = root + Ry(yaw) * normalised.
/// A normalised person faces +z with the left side at +x, HipCenter at the origin.
struct Placement {
  Eigen::Vector3d root_m = Eigen::Vector3d::Zero();  // HipCenter in camera space
  double yaw_rad = 0.0;                              // about y; pi faces the camera
};

/// Placement of a posture in camera space. The heading is that of the hip line and the shoulder
/// line, each weighed by its joints' weights; where neither can tell, `previous_yaw_rad`.
Placement EstimatePlacement(const Posture& in_camera, const JointWeights& weights,
                            double previous_yaw_rad);

/// Removes global translation and the rotation about the vertical (Shum & Ho 2012 sec. 5.1).
Posture Normalised(const Posture& in_camera, const Placement& camera_from_normalised);
/// The way back.
Posture Placed(const Posture& normalised, const Placement& camera_from_normalised);

/// Left and right exchanged, of a normalised posture: mirrored at x = 0.
Posture Mirrored(const Posture& normalised);

/// Every position multiplied by one factor.
Posture Scaled(const Posture& posture, double factor);

/// Shum & Ho 2012 eqs. 3-4: keeps every bone's direction, gives it the length asked for; the root
/// stays. A bone without direction (zero length, not finite) takes that of the standard stance.
Posture Retargeted(const Posture& posture, const BoneLengths& lengths_m);

/// The standard lengths multiplied by one factor.
BoneLengths ScaledBoneLengths(double scale);

/// The one factor by which the standard body best explains the bones whose both ends are trusted:
/// the weighted median of the ratios, kept within people of 0.9 m and 2.2 m. 1 when nothing is.
double EstimateBodyScale(const BoneLengths& lengths_m, const JointWeights& weights);

}  // namespace ossa::recon
