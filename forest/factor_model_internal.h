#pragma once
#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "forest/forest.h"

namespace ossa::forest {

/// What was measured of one target.
struct Site {
  double variance_m2 = 0.0;  // each axis, the factor model's noise included; 0: nothing measured
  Eigen::Vector3d mean_m = Eigen::Vector3d::Zero();
};

/// Where a target is by all that was measured of the others.
struct Prediction {
  Eigen::Vector3d predicted_m = Eigen::Vector3d::Zero();
  Eigen::Matrix3d covariance_m2 = Eigen::Matrix3d::Identity();
};

/// A pose prior (forest.h), the common place as three more factors, laid out for prediction. The
/// same bits on every machine.
class FactorModel {
 public:
  explicit FactorModel(const PosePrior& prior);

  /// One site and one prediction a target: the posterior of the factors given all sites, each
  /// target's own site taken out again.
  std::vector<Prediction> Predict(const std::vector<Site>& sites) const;
  /// Of a target about what the factors say, each axis.
  double variance_m2(size_t target) const { return variance_m2_[target]; }

 private:
  // Σ loadingᵀ · loading / variance + identity, its upper half.
  std::vector<double> Precision(const std::vector<Site>& sites) const;
  // Factor × column: loadings, an axis of all targets after the other, then what pulls the factors.
  std::vector<double> RightSides(const std::vector<Site>& sites) const;

  size_t targets_ = 0, factors_ = 0;
  size_t row_stride_ = 0;        // factors, filled up with zeros
  size_t axis_stride_ = 0;       // targets, filled up with zeros
  std::vector<double> rows_;     // target × axis × row_stride: loadings
  std::vector<double> columns_;  // factor × axis × axis_stride: the same
  std::vector<Eigen::Vector3d> mean_m_;
  std::vector<double> variance_m2_;
};

}  // namespace ossa::forest
