#pragma once
#include <Eigen/Core>

namespace ossa::recon {

/// Eigendecomposition of a symmetric matrix of n rows: eigenvalues, ascending, and unit
/// eigenvectors as columns.
template <typename Scalar>
struct Spectrum {
  Eigen::Matrix<Scalar, Eigen::Dynamic, 1> values;                // n
  Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic> vectors;  // n x n
};

/// Reads the lower triangle. Compiled once: Eigen's solver costs every including source seconds.
Spectrum<float> DecomposeSymmetric(const Eigen::MatrixXf& symmetric);
Spectrum<double> DecomposeSymmetric(const Eigen::MatrixXd& symmetric);

}  // namespace ossa::recon
