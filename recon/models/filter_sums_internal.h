#pragma once
#include <Eigen/Core>
#include <array>
#include <vector>

#include "recon/models/linear_filter.h"

namespace ossa::recon {

/// By definition: position errors without their mean; their second differences.
inline constexpr int kErrorParts = 2;

/// Consecutive frames in which the truth of a joint is known.
struct Stretch {
  std::vector<const PosturePair*> pairs;
  std::vector<Posture> seen;  // in camera space
};

/// Sums of products for each part: x the regressors, y the errors.
struct Products {
  std::array<Eigen::MatrixXd, kErrorParts> xx;
  std::array<Eigen::MatrixXd, kErrorParts> xy;  // a column per axis; influence weights: one for all

  void AddTimes(double factor, const Products& other);
};

/// Sums over the stretches of a fold.
struct FilterSums {
  // Of step weights: one for both outputs. Of influence weights: now and before, then their
  // robustly weighted versions from which the weights are learned, now and before.
  std::vector<Products> of;
  // For each part and output: sums of squared errors, of the raw joint and of LagFilter.
  std::array<std::array<double, LinearFilter::kOutputs>, kErrorParts> yy{}, lag{};
  double rows = 0.0;

  void operator+=(const FilterSums& other) { AddTimes(1.0, other); }
  FilterSums operator-(const FilterSums& part) const {
    FilterSums rest = *this;
    rest.AddTimes(-1.0, part);
    return rest;
  }

 private:
  void AddTimes(double factor, const FilterSums& other);
};

/// Sums for step weights, in the body frame of each frame; x negated for a mirrored joint.
FilterSums SumForSteps(const Stretch& stretch, size_t joint, bool mirrored);

/// Sums for influence weights, in camera space.
FilterSums SumForInfluences(const Stretch& stretch, size_t joint);

}  // namespace ossa::recon
