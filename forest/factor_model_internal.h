#pragma once
#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "forest/forest.h"

namespace ossa::forest {

/// The measurement of a target.
struct Site {
  double variance_m2 = 0.0;  // per axis, including the factor model's noise; 0: not measured
  Eigen::Vector3d mean_m = Eigen::Vector3d::Zero();
};

/// The prediction of a target by the measurements of all others.
struct Prediction {
  Eigen::Vector3d predicted_m = Eigen::Vector3d::Zero();
  Eigen::Matrix3d covariance_m2 = Eigen::Matrix3d::Identity();
};

/// A pose prior (forest.h), with the common position as three more factors, in a layout for fast
/// prediction. The same bits on every machine.
class FactorModel {
 public:
  explicit FactorModel(const PosePrior& prior);

  /// One site and one prediction per target: predictions from the posterior of the factors given
  /// all sites, without the target's own site.
  std::vector<Prediction> Predict(const std::vector<Site>& sites) const;
  /// Residual variance of a target given the factors, per axis.
  double variance_m2(size_t target) const { return variance_m2_[target]; }

 private:
  // The upper half of Σ loadingᵀ · loading / variance + identity.
  std::vector<double> Precision(const std::vector<Site>& sites) const;
  // Factor × column: the loadings of all targets axis by axis, then the right-hand side of the
  // factors.
  std::vector<double> RightSides(const std::vector<Site>& sites) const;

  size_t targets_ = 0, factors_ = 0;
  size_t row_stride_ = 0;        // number of factors, padded with zeros
  size_t axis_stride_ = 0;       // number of targets, padded with zeros
  std::vector<double> rows_;     // target × axis × row_stride: loadings
  std::vector<double> columns_;  // factor × axis × axis_stride: the same numbers
  std::vector<Eigen::Vector3d> mean_m_;
  std::vector<double> variance_m2_;
};

}  // namespace ossa::forest
