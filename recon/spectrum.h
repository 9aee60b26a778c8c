#pragma once
#include <Eigen/Core>

namespace ossa::recon {

/// Of a symmetric matrix of n rows: eigenvalues, rising, and the eigenvectors as columns in their
/// order, each of length 1.
template <typename Scalar>
struct Spectrum {
  Eigen::Matrix<Scalar, Eigen::Dynamic, 1> values;                // n
  Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic> vectors;  // n x n
};

/// Reads the lower triangle. Compiled once: Eigen's solver costs each source that calls it seconds.
Spectrum<float> DecomposeSymmetric(const Eigen::MatrixXf& symmetric);
Spectrum<double> DecomposeSymmetric(const Eigen::MatrixXd& symmetric);

}  // namespace ossa::recon
