// Shum et al. 2013, eq. 15, as least squares for Ceres.
#include <ceres/cost_function.h>
#include <ceres/problem.h>
#include <ceres/solver.h>

#include <cmath>

#include "recon/methods/posture_space_internal.h"

namespace ossa::recon {

EnergyResiduals::EnergyResiduals(const PostureSpace& space, const EnergyInputs& inputs,
                                 const LocalPcaOptions& options, int nearest)
    : basis_(space.basis.cast<double>()),
      mean_(space.mean.cast<double>()),
      observed_(inputs.observed.cast<double>()),
      control_weight_(
          (CoordinateWeights(inputs.reliability).cast<double>() * options.control).cwiseSqrt()),
      continuity_target_(Eigen::VectorXd::Zero(kPostureDims)),
      style_target_(space.neighbours.col(nearest).cast<double>()),
      lengths_m_(inputs.lengths_m),
      kinematics_weight_(std::sqrt(options.kinematics / (kJointCount - 1))),
      continuity_weight_(0.0),
      style_weight_(std::sqrt(options.style / kJointCount)) {
  if (!inputs.last || !inputs.before_last) return;
  continuity_weight_ = std::sqrt(options.continuity / kJointCount);
  continuity_target_ = (2.0F * *inputs.last - *inputs.before_last).cast<double>();
}

int EnergyResiduals::rows() const {
  return 2 * kPostureDims + (kJointCount - 1) + static_cast<int>(basis_.cols());
}

void EnergyResiduals::Evaluate(const Eigen::VectorXd& q, Eigen::VectorXd& residuals,
                               Eigen::MatrixXd* jacobian) const {
  const Eigen::VectorXd x = mean_ + basis_ * q;
  const Eigen::Index dims = basis_.cols();
  residuals.resize(rows());
  if (jacobian != nullptr) jacobian->resize(rows(), dims);

  residuals.head(kPostureDims) = control_weight_.cwiseProduct(x - observed_);  // eq. 10
  if (jacobian != nullptr) jacobian->topRows(kPostureDims) = control_weight_.asDiagonal() * basis_;

  Eigen::Index row = kPostureDims;
  for (size_t i = 1; i < kJointCount; ++i, ++row) {  // eq. 12
    const Eigen::Index end = FirstCoordinate(i), begin = FirstCoordinate(ParentOf(i));
    const Eigen::Vector3d bone = x.segment<3>(end) - x.segment<3>(begin);
    const double length = std::max(bone.norm(), 1e-9);
    residuals[row] = kinematics_weight_ * (length - lengths_m_[i]);
    if (jacobian == nullptr) continue;
    jacobian->row(row) = kinematics_weight_ / length * bone.transpose() *
                         (basis_.middleRows<3>(end) - basis_.middleRows<3>(begin));
  }

  residuals.segment(row, kPostureDims) = continuity_weight_ * (x - continuity_target_);  // eq. 14
  if (jacobian != nullptr) jacobian->middleRows(row, kPostureDims) = continuity_weight_ * basis_;
  row += kPostureDims;

  residuals.tail(dims) = style_weight_ * (q - style_target_);  // eq. 11
  if (jacobian != nullptr) {
    jacobian->bottomRows(dims) = style_weight_ * Eigen::MatrixXd::Identity(dims, dims);
  }
}

namespace {

class CeresEnergy : public ceres::CostFunction {
 public:
  CeresEnergy(const EnergyResiduals& residuals, int dimensions) : residuals_(residuals) {
    set_num_residuals(residuals.rows());
    mutable_parameter_block_sizes()->push_back(dimensions);
  }

  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override {
    const int dims = parameter_block_sizes()[0];
    const Eigen::VectorXd q = Eigen::Map<const Eigen::VectorXd>(parameters[0], dims);
    Eigen::VectorXd r;
    Eigen::MatrixXd j;
    const bool wanted = jacobians != nullptr && jacobians[0] != nullptr;
    residuals_.Evaluate(q, r, wanted ? &j : nullptr);
    Eigen::Map<Eigen::VectorXd>(residuals, r.size()) = r;
    if (wanted) {
      Eigen::Map<Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>(
          jacobians[0], j.rows(), j.cols()) = j;
    }
    return r.allFinite();
  }

 private:
  const EnergyResiduals& residuals_;
};

int NearestNeighbour(const PostureSpace& space, const Eigen::VectorXf& q) {
  Eigen::Index nearest = 0;
  ((space.neighbours.colwise() - q).colwise().squaredNorm() + space.outside.transpose())
      .minCoeff(&nearest);
  return static_cast<int>(nearest);
}

}  // namespace

SearchResult SearchCeres(const PostureSpace& space, const EnergyInputs& inputs,
                         const LocalPcaOptions& options, const Eigen::VectorXf& start) {
  SearchResult result{start, 0.0, 0};
  constexpr int kRuns = 3;  // by hand: the nearest neighbour rarely changes more than once
  for (int run = 0, last = -1; run < kRuns && space.dimensions() > 0; ++run) {
    const int nearest = NearestNeighbour(space, result.q);
    if (nearest == last) break;
    last = nearest;
    const EnergyResiduals residuals(space, inputs, options, nearest);
    Eigen::VectorXd q = result.q.cast<double>();
    CeresEnergy cost(residuals, space.dimensions());
    ceres::Problem::Options problem_options;
    problem_options.cost_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
    ceres::Problem problem(problem_options);
    problem.AddResidualBlock(&cost, nullptr, q.data());
    ceres::Solver::Options solver;
    solver.linear_solver_type = ceres::DENSE_QR;
    solver.logging_type = ceres::SILENT;
    solver.max_num_iterations = options.steps;
    solver.function_tolerance = 1e-4;
    ceres::Solver::Summary summary;
    ceres::Solve(solver, &problem, &summary);
    if (!summary.IsSolutionUsable() || !q.allFinite()) break;
    result.q = q.cast<float>();
    result.steps += static_cast<int>(summary.iterations.size());
  }
  result.energy = Energies(space, inputs, options, result.q.transpose())[0];
  return result;
}

}  // namespace ossa::recon
