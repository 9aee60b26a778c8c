#include "recon/models/filter_sums_internal.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "recon/filters/lag_filter_internal.h"

namespace ossa::recon {
namespace {

constexpr Eigen::Index kColumns = 3 * LinearFilter::kOutputs;
constexpr double kPrecise_m = 0.01;  // by hand: errors below are noise and get equal weight

/// Truth minus observation, metres in the body frame; x negated for a mirrored joint.
Eigen::Vector3d ComputeError(const PosturePair& pair, size_t joint, bool mirrored) {
  Eigen::Vector3d error = pair.scale * pair.residual.position_m[joint];
  if (mirrored) error.x() = -error.x();
  return error;
}

Eigen::Vector3d Turned(const Eigen::Vector3d& p, double angle_rad) {
  const double c = std::cos(angle_rad), s = std::sin(angle_rad);
  return {c * p.x() + s * p.z(), p.y(), -s * p.x() + c * p.z()};
}

/// Remaining error of each output with LagFilter, from frame kFewest on.
Eigen::MatrixXd ResidualsOfLagFilter(const Stretch& stretch, size_t joint) {
  Eigen::MatrixXd left(static_cast<Eigen::Index>(stretch.seen.size()), kColumns);
  LagFilter filter;
  for (size_t f = 0; f < stretch.seen.size(); ++f) {
    const PosturePair& pair = *stretch.pairs[f];
    const PosturePair& last = *stretch.pairs[f == 0 ? 0 : f - 1];
    const auto truth = [&](size_t frame, const PosturePair& of) -> Eigen::Vector3d {
      return stretch.seen[frame].position_m[joint] +
             Turned(ComputeError(of, joint, false), of.placement.yaw_rad);
    };
    const double dt_s = f == 0 ? 1.0 / 30.0 : pair.time_s - last.time_s;
    const Eigen::Vector3d now = filter.Step(stretch.seen[f].position_m[joint], dt_s, 1.0);
    const auto row = static_cast<Eigen::Index>(f);
    left.row(row).head<3>() = truth(f, pair) - now;
    left.row(row).tail<3>() = truth(f == 0 ? 0 : f - 1, last) - filter.before_m();
  }
  return left.bottomRows(left.rows() - LinearFilter::kFewest);
}

Eigen::MatrixXd Part(const Eigen::MatrixXd& m, size_t part) {
  if (part == 0) return m.rowwise() - m.colwise().mean();
  const Eigen::Index n = m.rows() - 2;
  return m.bottomRows(n) - 2.0 * m.middleRows(1, n) + m.topRows(n);
}

/// The filter's input in a frame, and how many steps are valid.
struct FilterInput {
  std::span<const Posture> window;
  LinearFilter::Steps steps;
};

FilterInput FilterInputAt(const Stretch& stretch, size_t frame) {
  const size_t known = std::min(frame, size_t{LinearFilter::kSteps});
  FilterInput seen{std::span(stretch.seen).subspan(frame - known, known + 1), {}};
  seen.steps.fill(static_cast<int>(known));
  return seen;
}

/// Errors of both outputs, from frame kFewest on, in the current body frame.
Eigen::MatrixXd ComputeErrors(const Stretch& stretch, size_t joint, bool mirrored) {
  Eigen::MatrixXd y(static_cast<Eigen::Index>(stretch.seen.size()) - LinearFilter::kFewest,
                    kColumns);
  for (Eigen::Index r = 0; r < y.rows(); ++r) {
    const auto frame = static_cast<size_t>(r) + LinearFilter::kFewest;
    const PosturePair& now = *stretch.pairs[frame];
    const PosturePair& before = *stretch.pairs[frame - 1];
    const double turn = before.placement.yaw_rad - now.placement.yaw_rad;
    y.row(r).head<3>() = ComputeError(now, joint, mirrored);
    y.row(r).tail<3>() = Turned(ComputeError(before, joint, mirrored), mirrored ? -turn : turn);
  }
  return y;
}

/// The error sums, without products.
FilterSums SumErrors(const Stretch& stretch, size_t joint, const Eigen::MatrixXd& y,
                     double weight) {
  const Eigen::MatrixXd lag = ResidualsOfLagFilter(stretch, joint);
  FilterSums sums;
  sums.rows = static_cast<double>(y.rows());
  for (size_t part = 0; part < kErrorParts; ++part) {
    const Eigen::MatrixXd ys = Part(y, part), ls = Part(lag, part);
    for (Eigen::Index o = 0; o < LinearFilter::kOutputs; ++o) {
      const auto output = static_cast<size_t>(o);
      sums.yy[part][output] = weight * ys.middleCols<3>(3 * o).squaredNorm();
      sums.lag[part][output] = weight * ls.middleCols<3>(3 * o).squaredNorm();
    }
  }
  return sums;
}

double ComputeWeight(const Eigen::MatrixXd& y) {
  const Eigen::MatrixXd centred = Part(y, 0);
  const double spread_m =
      std::sqrt(centred.leftCols<3>().squaredNorm() / static_cast<double>(y.rows()));
  return 1.0 / (spread_m + kPrecise_m);
}

/// Influence weights are shared by all axes, so axes are summed. x: one row per frame, one column
/// per regressor and axis, grouped by axis; y: one column per axis; `weights`: per frame.
void AddInfluences(const Eigen::MatrixXd& x, const Eigen::MatrixXd& y,
                   const Eigen::VectorXd& weights, size_t part, Products* influences) {
  const Eigen::Index n = x.cols() / 3;
  influences->xx[part] = Eigen::MatrixXd::Zero(n, n);
  influences->xy[part] = Eigen::MatrixXd::Zero(n, 1);
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    const auto of_axis = x.middleCols(axis * n, n);
    const Eigen::MatrixXd weighed = of_axis.array().colwise() * weights.array();
    influences->xx[part] += weighed.transpose() * of_axis;
    influences->xy[part] += weighed.transpose() * y.col(axis);
  }
}

}  // namespace

void Products::AddTimes(double factor, const Products& other) {
  for (size_t part = 0; part < kErrorParts; ++part) {
    if (xx[part].size() == 0) {
      xx[part] = Eigen::MatrixXd::Zero(other.xx[part].rows(), other.xx[part].cols());
      xy[part] = Eigen::MatrixXd::Zero(other.xy[part].rows(), other.xy[part].cols());
    }
    xx[part] += factor * other.xx[part];
    xy[part] += factor * other.xy[part];
  }
}

void FilterSums::AddTimes(double factor, const FilterSums& other) {
  if (other.rows == 0.0) return;
  rows += factor * other.rows;
  of.resize(other.of.size());
  for (size_t k = 0; k < of.size(); ++k) of[k].AddTimes(factor, other.of[k]);
  for (size_t part = 0; part < kErrorParts; ++part) {
    for (size_t o = 0; o < LinearFilter::kOutputs; ++o) {
      yy[part][o] += factor * other.yy[part][o];
      lag[part][o] += factor * other.lag[part][o];
    }
  }
}

FilterSums SumForSteps(const Stretch& stretch, size_t joint, bool mirrored) {
  const Eigen::MatrixXd y = ComputeErrors(stretch, joint, mirrored);
  Eigen::MatrixXd x(y.rows(), FilterFeatureSize(joint));
  for (Eigen::Index r = 0; r < x.rows(); ++r) {
    const auto frame = static_cast<size_t>(r) + LinearFilter::kFewest;
    const auto [window, steps] = FilterInputAt(stretch, frame);
    const double yaw_rad = stretch.pairs[frame]->placement.yaw_rad;
    x.row(r) = FilterFeature(window, steps, yaw_rad, joint, mirrored).transpose().cast<double>();
  }
  const double weight = ComputeWeight(y);
  FilterSums sums = SumErrors(stretch, joint, y, weight);
  Products& of = sums.of.emplace_back();
  for (size_t part = 0; part < kErrorParts; ++part) {
    const Eigen::MatrixXd xs = Part(x, part), ys = Part(y, part);
    of.xx[part] = Eigen::MatrixXd::Zero(x.cols(), x.cols());
    of.xx[part].selfadjointView<Eigen::Lower>().rankUpdate(xs.transpose(), weight);
    of.xx[part].triangularView<Eigen::StrictlyUpper>() = of.xx[part].transpose();
    of.xy[part] = weight * xs.transpose() * ys;
  }
  return sums;
}

FilterSums SumForInfluences(const Stretch& stretch, size_t joint) {
  Eigen::MatrixXd y = ComputeErrors(stretch, joint, false);
  std::array<Eigen::MatrixXd, LinearFilter::kOutputs> x;
  for (const auto output : {LinearFilter::kNow, LinearFilter::kBefore}) {
    x[output].resize(y.rows(), 3 * InfluenceFeatureSize(output));
    for (Eigen::Index r = 0; r < y.rows(); ++r) {
      const auto frame = static_cast<size_t>(r) + LinearFilter::kFewest;
      const auto [window, steps] = FilterInputAt(stretch, frame);
      const auto influences = InfluenceFeature(window, steps[joint], joint, output);
      x[output].row(r) = influences.transpose().reshaped().transpose().cast<double>();
      const double yaw_rad = stretch.pairs[frame]->placement.yaw_rad;
      const auto error = y.row(r).segment<3>(3 * static_cast<Eigen::Index>(output));
      y.row(r).segment<3>(3 * static_cast<Eigen::Index>(output)) =
          Turned(error.transpose(), yaw_rad).transpose();
    }
  }
  const double weight = ComputeWeight(y);
  FilterSums sums = SumErrors(stretch, joint, y, weight);
  sums.of.resize(2 * LinearFilter::kOutputs);
  for (size_t part = 0; part < kErrorParts; ++part) {
    const Eigen::MatrixXd ys = Part(y, part);
    // Weights by the inverse error approximate a sum of absolute errors: squares would be dominated
    // by a few gross errors.
    const Eigen::VectorXd robust =
        (ys.leftCols<3>().rowwise().norm().array() + kPrecise_m).inverse();
    const Eigen::VectorXd same = Eigen::VectorXd::Constant(ys.rows(), weight);
    for (size_t o = 0; o < LinearFilter::kOutputs; ++o) {
      const Eigen::MatrixXd xs = Part(x[o], part);
      const Eigen::MatrixXd of_output = ys.middleCols<3>(3 * static_cast<Eigen::Index>(o));
      AddInfluences(xs, of_output, same, part, &sums.of[o]);
      AddInfluences(xs, of_output, robust, part, &sums.of[LinearFilter::kOutputs + o]);
    }
  }
  return sums;
}

}  // namespace ossa::recon
