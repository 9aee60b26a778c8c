#include "recon/spectrum.h"

#include <Eigen/Eigenvalues>

namespace ossa::recon {
namespace {

template <typename Matrix>
Spectrum<typename Matrix::Scalar> Solve(const Matrix& symmetric) {
  const Eigen::SelfAdjointEigenSolver<Matrix> solver(symmetric);
  return {solver.eigenvalues(), solver.eigenvectors()};
}

}  // namespace

Spectrum<float> DecomposeSymmetric(const Eigen::MatrixXf& symmetric) { return Solve(symmetric); }
Spectrum<double> DecomposeSymmetric(const Eigen::MatrixXd& symmetric) { return Solve(symmetric); }

}  // namespace ossa::recon
