#pragma once
#include <vector>

#include "recon/fit/fit_terms_internal.h"
#include "recon/fit/normal_equations.h"
#include "tests/recon/fit/posed_person.h"

namespace ossa::recon {

/// Something that a place of the body is drawn to: residual root * (place - to_m). `root' root` is
/// the inverse of its covariance, robust weights included, as they are at one pose.
struct DrawnPlace {
  size_t segment = 0;
  ShapedPlace place;
  Eigen::Vector3d to_m = Eigen::Vector3d::Zero();
  Eigen::Matrix3d root = Eigen::Matrix3d::Zero();
};

/// What the fit minimises at a pose, written down anew from what its options say: correspondences
/// and robust weights are held, as each of its steps holds them.
struct ExactProblem {
  SurfacePose pose;  // unknowns are motion from here
  std::vector<DrawnPlace> places;
  ShapeVector known_shape = ShapeVector::Zero();
  double turn_weight = 0.0, shape_weight = 0.0;  // 0: no prior

  /// Joints, pixels and silhouette about the posed surface; no priors.
  static ExactProblem About(const PosedSurface& posed, const SeenPerson& seen,
                            const SurfaceFitInput& input, const SurfaceFitOptions& options);
};

/// Cost, gradient and Gauss-Newton matrix J'J at the problem's pose, by Ceres' derivatives.
struct ExactEquations {
  double cost = 0.0;
  FitStep gradient;
  NormalEquations::Matrix matrix;
};
ExactEquations Differentiate(const ExactProblem& problem);

/// The pose at the minimum, by Ceres' trust region to a standstill.
SurfacePose Minimise(const ExactProblem& problem);

}  // namespace ossa::recon
