#pragma once
#include <vector>

#include "recon/fit/fit_terms_internal.h"
#include "recon/fit/normal_equations.h"
#include "tests/recon/fit/posed_person.h"

namespace ossa::recon {

/// A target of a point on the body: residual root * (place - to_m). `root' root` is the inverse
/// covariance, including robust weights, at one pose.
struct DrawnPlace {
  size_t segment = 0;
  ShapedPlace place;
  Eigen::Vector3d to_m = Eigen::Vector3d::Zero();
  Eigen::Matrix3d root = Eigen::Matrix3d::Zero();
};

/// The fit's objective at a pose, written independently from its options: correspondences and
/// robust weights are constant, as within one step of the fit.
struct ExactProblem {
  SurfacePose pose;  // unknowns are relative to it
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

/// The pose at the minimum, by Ceres' trust region method to convergence.
SurfacePose Minimise(const ExactProblem& problem);

}  // namespace ossa::recon
