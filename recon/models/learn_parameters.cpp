#include <ceres/first_order_function.h>
#include <ceres/gradient_problem.h>
#include <ceres/gradient_problem_solver.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "recon/models/gaussian_process.h"

namespace ossa::recon {
namespace {

// Logarithms of plausible bounds: signal 1 mm to 1 m, width 3 cm to 10 m, noise 1 mm to 20 cm.
// Outside, the likelihood is flat and the matrix singular.
constexpr std::array<double, 4> kLowest = {-13.8, -13.8, -4.6, 3.2};
constexpr std::array<double, 4> kHighest = {0.0, 0.0, 7.0, 13.8};

GaussianProcessParameters FromLogarithms(const double* logs) {
  const auto value = [logs](size_t i) {
    return std::exp(std::clamp(logs[i], kLowest[i], kHighest[i]));
  };
  return {value(0), value(1), value(2), value(3)};
}

class Likelihood : public ceres::FirstOrderFunction {
 public:
  Likelihood(const Eigen::MatrixXd& inputs, const Eigen::MatrixXd& outputs)
      : inputs_(inputs), outputs_(outputs) {}
  int NumParameters() const override { return 4; }

  bool Evaluate(const double* logs, double* cost, double* gradient) const override {
    *cost = NegativeLogLikelihood(FromLogarithms(logs), inputs_, outputs_, gradient);
    // A quadratic penalty keeps the search inside the bounds.
    for (size_t i = 0; i < 4; ++i) {
      const double out = logs[i] - std::clamp(logs[i], kLowest[i], kHighest[i]);
      *cost += 100.0 * out * out;
      if (gradient != nullptr && out != 0.0) gradient[i] = 200.0 * out;
    }
    return std::isfinite(*cost);
  }

 private:
  const Eigen::MatrixXd& inputs_;
  const Eigen::MatrixXd& outputs_;
};

}  // namespace

GaussianProcessParameters LearnParameters(const Eigen::MatrixXd& inputs,
                                          const Eigen::MatrixXd& outputs,
                                          const GaussianProcessParameters& start) {
  std::array<double, 4> logs = {std::log(start.theta0), std::log(start.theta1), std::log(start.w),
                                std::log(start.beta)};
  const ceres::GradientProblem problem(new Likelihood(inputs, outputs));
  ceres::GradientProblemSolver::Options options;
  options.logging_type = ceres::SILENT;
  options.max_num_iterations = 25;  // a per cent of accuracy is enough: the maximum is flat
  options.function_tolerance = 1e-4;
  ceres::GradientProblemSolver::Summary summary;
  ceres::Solve(options, problem, logs.data(), &summary);
  const bool finite =
      std::all_of(logs.begin(), logs.end(), [](double l) { return std::isfinite(l); });
  if (!summary.IsSolutionUsable() || !finite) return start;
  return FromLogarithms(logs.data());
}

}  // namespace ossa::recon
