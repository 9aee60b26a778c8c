// Z. Liu, L. Zhou, H. Leung, H. P. H. Shum, Kinect posture reconstruction based on a local mixture
// of Gaussian process models, IEEE TVCG 2016, sections 3.2, 4.1 and 4.2.3.
#include "recon/models/gaussian_process.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace ossa::recon {
namespace {

Eigen::MatrixXd SquaredDistances(const Eigen::MatrixXd& x) {
  const Eigen::VectorXd norms = x.rowwise().squaredNorm();
  Eigen::MatrixXd d = -2.0 * x * x.transpose();
  d.colwise() += norms;
  d.rowwise() += norms.transpose();
  return d.cwiseMax(0.0);
}

}  // namespace

Eigen::MatrixXd KernelMatrix(const GaussianProcessParameters& p, const Eigen::MatrixXd& inputs) {
  Eigen::MatrixXd k =
      (p.theta0 * (-0.5 * p.w * SquaredDistances(inputs).array()).exp() + p.theta1).matrix();
  k.diagonal().array() += 1.0 / p.beta;
  return k;
}

GaussianProcess::GaussianProcess(GaussianProcessParameters parameters, Eigen::MatrixXd inputs,
                                 Eigen::MatrixXd outputs)
    : parameters_(parameters), inputs_(std::move(inputs)), outputs_(std::move(outputs)) {
  factor_ = KernelMatrix(parameters_, inputs_).llt().matrixL();
  alpha_ = factor_.triangularView<Eigen::Lower>().solve(outputs_);
  factor_.triangularView<Eigen::Lower>().adjoint().solveInPlace(alpha_);
}

Eigen::VectorXd GaussianProcess::KernelWith(const Eigen::VectorXd& input) const {
  const Eigen::ArrayXd d2 = (inputs_.rowwise() - input.transpose()).rowwise().squaredNorm();
  return (parameters_.theta0 * (-0.5 * parameters_.w * d2).exp() + parameters_.theta1).matrix();
}

Eigen::Vector3d GaussianProcess::PredictMean(const Eigen::VectorXd& input) const {
  return alpha_.transpose() * KernelWith(input);  // eq. 8
}

GaussianPrediction GaussianProcess::Predict(const Eigen::VectorXd& input) const {
  const Eigen::VectorXd k = KernelWith(input);
  GaussianPrediction out;
  out.mean = alpha_.transpose() * k;
  const Eigen::VectorXd v = factor_.triangularView<Eigen::Lower>().solve(k);
  out.variance = std::max(parameters_.theta0 + parameters_.theta1 - v.squaredNorm(), 0.0);  // eq. 9
  out.noise = 1.0 / parameters_.beta;
  return out;
}

void GaussianProcess::Add(const Eigen::VectorXd& input, const Eigen::Vector3d& output) {
  const Eigen::Index n = inputs_.rows();
  // Departure: eq. 17 prints U u = k_new; from eqs. 15-16 it is U' u = k_new.
  const Eigen::VectorXd u = factor_.triangularView<Eigen::Lower>().solve(KernelWith(input));
  const double k = parameters_.theta0 + parameters_.theta1 + 1.0 / parameters_.beta;
  inputs_.conservativeResize(n + 1, Eigen::NoChange);
  inputs_.row(n) = input.transpose();
  outputs_.conservativeResize(n + 1, Eigen::NoChange);
  outputs_.row(n) = output.transpose();
  factor_.conservativeResize(n + 1, n + 1);
  factor_.col(n).setZero();
  factor_.row(n).head(n) = u.transpose();
  factor_(n, n) = std::sqrt(std::max(k - u.squaredNorm(), 1e-3 / parameters_.beta));
  alpha_ = factor_.triangularView<Eigen::Lower>().solve(outputs_);
  factor_.triangularView<Eigen::Lower>().adjoint().solveInPlace(alpha_);
}

double NegativeLogLikelihood(const GaussianProcessParameters& p, const Eigen::MatrixXd& inputs,
                             const Eigen::MatrixXd& outputs, double gradient[4]) {
  const Eigen::Index n = inputs.rows();
  const auto columns = static_cast<double>(outputs.cols());
  const Eigen::LLT<Eigen::MatrixXd> llt(KernelMatrix(p, inputs));
  if (llt.info() != Eigen::Success) return std::numeric_limits<double>::infinity();
  const Eigen::MatrixXd alpha = llt.solve(outputs);
  const double log_det = 2.0 * llt.matrixLLT().diagonal().array().log().sum();
  const double value = 0.5 * outputs.cwiseProduct(alpha).sum() + 0.5 * columns * log_det;
  if (gradient == nullptr) return value;
  // d/dp = 1/2 tr((c K^-1 - alpha alpha') dK/dp); c outputs share K.
  const Eigen::MatrixXd g =
      columns * llt.solve(Eigen::MatrixXd::Identity(n, n)) - alpha * alpha.transpose();
  const Eigen::MatrixXd d2 = SquaredDistances(inputs);
  const Eigen::MatrixXd rbf = (p.theta0 * (-0.5 * p.w * d2.array()).exp()).matrix();
  gradient[0] = 0.5 * g.cwiseProduct(rbf).sum();
  gradient[1] = 0.5 * p.theta1 * g.sum();
  gradient[2] = -0.25 * p.w * g.cwiseProduct(rbf).cwiseProduct(d2).sum();
  gradient[3] = -0.5 / p.beta * g.trace();
  return value;
}

std::vector<int> BudgetedSamples(const GaussianProcessParameters& p, const Eigen::MatrixXd& inputs,
                                 const Eigen::MatrixXd& outputs, int keep) {
  std::vector<int> rows(static_cast<size_t>(inputs.rows()));
  std::iota(rows.begin(), rows.end(), 0);
  const double noise = 1.0 / p.beta;
  Eigen::MatrixXd inverse =
      KernelMatrix(p, inputs).llt().solve(Eigen::MatrixXd::Identity(inputs.rows(), inputs.rows()));
  Eigen::MatrixXd y = outputs;
  while (static_cast<int>(rows.size()) > std::max(keep, 1)) {
    const Eigen::MatrixXd alpha = inverse * y;
    int least = 0;
    double least_kl = std::numeric_limits<double>::infinity();
    for (Eigen::Index t = 0; t < inverse.rows(); ++t) {
      // Leave-one-out in closed form: without sample t the mean is y - alpha_t / K^-1_tt and the
      // variance 1 / K^-1_tt; with it the mean is y - alpha_t / beta and the variance noise (2 -
      // noise K^-1_tt).
      const double without = 1.0 / inverse(t, t);
      const double with = std::max(noise * (2.0 - noise * inverse(t, t)), 1e-3 * noise);
      const double shift2 = alpha.row(t).squaredNorm() * std::pow(without - noise, 2.0);
      const double kl = 1.5 * (std::log(without / with) + with / without - 1.0) +
                        0.5 * shift2 / without;  // three outputs
      if (kl < least_kl) least_kl = kl, least = static_cast<int>(t);
    }
    // Block inverse: K^-1 without row and column t.
    const Eigen::Index n = inverse.rows(), t = least;
    const Eigen::VectorXd column = inverse.col(t);
    Eigen::MatrixXd smaller = inverse - column * column.transpose() / column[t];
    smaller.middleRows(t, n - 1 - t) = smaller.bottomRows(n - 1 - t).eval();
    smaller.middleCols(t, n - 1 - t) = smaller.rightCols(n - 1 - t).eval();
    inverse = smaller.topLeftCorner(n - 1, n - 1).eval();
    y.middleRows(t, n - 1 - t) = y.bottomRows(n - 1 - t).eval();
    y.conservativeResize(n - 1, Eigen::NoChange);
    rows.erase(rows.begin() + least);
  }
  return rows;
}

}  // namespace ossa::recon
