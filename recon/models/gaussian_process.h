#pragma once
#include <Eigen/Core>
#include <vector>

namespace ossa::recon {

// Constants: where learning starts, by hand.

/// Phi of Liu et al. 2016 eq. 5: k(a, b) = theta0 exp(-w |a - b|^2 / 2) + theta1 + delta_ab / beta.
/// W of the paper is w times the identity. Features in metres, outputs in metres.
struct GaussianProcessParameters {
  double theta0 = 1e-3;  // square metres
  double theta1 = 1e-3;  // square metres
  double w = 25.0;       // 1 / square metres: width 20 cm
  double beta = 1e4;     // 1 / square metres: noise 1 cm
};

/// Mean and variance of a Gaussian process at one input.
struct GaussianPrediction {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();  // eq. 8
  double variance = 0.0;                           // eq. 9, of each coordinate, without the noise
  double noise = 0.0;  // noise variance of the predicting models, square metres
};

/// Gaussian process regression from a feature to a 3D offset; the three coordinates share the
/// kernel.
class GaussianProcess {
 public:
  GaussianProcess() = default;
  /// inputs: one sample per row; outputs: as many rows, 3 columns. At least one sample.
  GaussianProcess(GaussianProcessParameters parameters, Eigen::MatrixXd inputs,
                  Eigen::MatrixXd outputs);

  GaussianPrediction Predict(const Eigen::VectorXd& input) const;
  /// Only the mean, without a triangular solve.
  Eigen::Vector3d PredictMean(const Eigen::VectorXd& input) const;
  /// Adds a sample in O(S^2): the Cholesky factor grows by a row (eqs. 15-17).
  void Add(const Eigen::VectorXd& input, const Eigen::Vector3d& output);

  int size() const { return static_cast<int>(inputs_.rows()); }
  const GaussianProcessParameters& parameters() const { return parameters_; }
  const Eigen::MatrixXd& inputs() const { return inputs_; }
  const Eigen::MatrixXd& outputs() const { return outputs_; }
  const Eigen::MatrixXd& factor() const { return factor_; }  // L = U' with K = L L'

 private:
  Eigen::VectorXd KernelWith(const Eigen::VectorXd& input) const;

  GaussianProcessParameters parameters_;
  Eigen::MatrixXd inputs_, outputs_;
  Eigen::MatrixXd factor_;  // lower triangular, U' of eq. 14
  Eigen::MatrixXd alpha_;   // K^-1 Y of eq. 8
};

/// K of eq. 5 over the rows of `inputs`.
Eigen::MatrixXd KernelMatrix(const GaussianProcessParameters& parameters,
                             const Eigen::MatrixXd& inputs);

/// Minus the log marginal likelihood of eq. 6 summed over the output columns, and its gradient with
/// respect to the logarithms of (theta0, theta1, w, beta); the gradient may be null.
double NegativeLogLikelihood(const GaussianProcessParameters& parameters,
                             const Eigen::MatrixXd& inputs, const Eigen::MatrixXd& outputs,
                             double gradient[4]);

/// Parameters that maximise eq. 6, starting from `start`, by L-BFGS (Ceres) within plausible
/// bounds; `start` if the optimisation fails.
GaussianProcessParameters LearnParameters(const Eigen::MatrixXd& inputs,
                                          const Eigen::MatrixXd& outputs,
                                          const GaussianProcessParameters& start);

/// Liu 2016 sec. 3.2, posture budgeting: repeatedly drops the sample whose removal changes the
/// prediction at its own input least (KL divergence of eqs. 1-2) until `keep` are left (the paper
/// gives no limit of the divergence, but the size S of a local model). Returns the kept rows,
/// ascending.
std::vector<int> BudgetedSamples(const GaussianProcessParameters& parameters,
                                 const Eigen::MatrixXd& inputs, const Eigen::MatrixXd& outputs,
                                 int keep);

}  // namespace ossa::recon
