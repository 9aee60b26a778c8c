// LinearFilter::Learn. All held-out errors, for any ridge strength, are computed from products of
// regressors and errors that are accumulated once.
#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>

#include "depth/base/statistics.h"
#include "recon/filters/lag_filter_internal.h"
#include "recon/models/linear_filter.h"

namespace ossa::recon {
namespace {

// Constants: chosen by hand unless stated otherwise.

constexpr int kParts = 2;  // position errors without their mean; their second differences
constexpr Eigen::Index kColumns = 3 * LinearFilter::kOutputs;

/// Consecutive frames in which the truth of a joint is known.
struct Stretch {
  std::vector<const PosturePair*> pairs;
  std::vector<Posture> seen;  // in camera space
};

/// Sums of products for each part: x the regressors, y the errors.
struct Products {
  std::array<Eigen::MatrixXd, kParts> xx;
  std::array<Eigen::MatrixXd, kParts> xy;  // a column per axis; influence weights: one for all

  void AddTimes(double factor, const Products& other);
};

void Products::AddTimes(double factor, const Products& other) {
  for (size_t part = 0; part < kParts; ++part) {
    if (xx[part].size() == 0) {
      xx[part] = Eigen::MatrixXd::Zero(other.xx[part].rows(), other.xx[part].cols());
      xy[part] = Eigen::MatrixXd::Zero(other.xy[part].rows(), other.xy[part].cols());
    }
    xx[part] += factor * other.xx[part];
    xy[part] += factor * other.xy[part];
  }
}

/// Sums over the stretches of a fold.
struct Sums {
  // Of step weights: one for both outputs. Of influence weights: now and before, then their
  // robustly weighted versions from which the weights are learned, now and before.
  std::vector<Products> of;
  // For each part and output: sums of squared errors, of the raw joint and of LagFilter.
  std::array<std::array<double, LinearFilter::kOutputs>, kParts> yy{}, lag{};
  double rows = 0.0;

  void operator+=(const Sums& other) { AddTimes(1.0, other); }
  Sums operator-(const Sums& part) const {
    Sums rest = *this;
    rest.AddTimes(-1.0, part);
    return rest;
  }

 private:
  void AddTimes(double factor, const Sums& other);
};

void Sums::AddTimes(double factor, const Sums& other) {
  if (other.rows == 0.0) return;
  rows += factor * other.rows;
  of.resize(other.of.size());
  for (size_t k = 0; k < of.size(); ++k) of[k].AddTimes(factor, other.of[k]);
  for (size_t part = 0; part < kParts; ++part) {
    for (size_t o = 0; o < LinearFilter::kOutputs; ++o) {
      yy[part][o] += factor * other.yy[part][o];
      lag[part][o] += factor * other.lag[part][o];
    }
  }
}

Posture InCamera(const PosturePair& pair) {
  return Placed(Scaled(pair.observed, pair.scale), pair.placement);
}

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

constexpr double kPrecise_m = 0.01;  // errors below are noise and get equal weight

/// The error sums, without products.
Sums ErrorSums(const Stretch& stretch, size_t joint, const Eigen::MatrixXd& y, double weight) {
  const Eigen::MatrixXd lag = ResidualsOfLagFilter(stretch, joint);
  Sums sums;
  sums.rows = static_cast<double>(y.rows());
  for (size_t part = 0; part < kParts; ++part) {
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

Sums StepSums(const Stretch& stretch, size_t joint, bool mirrored) {
  const Eigen::MatrixXd y = ComputeErrors(stretch, joint, mirrored);
  Eigen::MatrixXd x(y.rows(), FilterFeatureSize(joint));
  for (Eigen::Index r = 0; r < x.rows(); ++r) {
    const auto frame = static_cast<size_t>(r) + LinearFilter::kFewest;
    const auto [window, steps] = FilterInputAt(stretch, frame);
    const double yaw_rad = stretch.pairs[frame]->placement.yaw_rad;
    x.row(r) = FilterFeature(window, steps, yaw_rad, joint, mirrored).transpose().cast<double>();
  }
  const double weight = ComputeWeight(y);
  Sums sums = ErrorSums(stretch, joint, y, weight);
  Products& of = sums.of.emplace_back();
  for (size_t part = 0; part < kParts; ++part) {
    const Eigen::MatrixXd xs = Part(x, part), ys = Part(y, part);
    of.xx[part] = Eigen::MatrixXd::Zero(x.cols(), x.cols());
    of.xx[part].selfadjointView<Eigen::Lower>().rankUpdate(xs.transpose(), weight);
    of.xx[part].triangularView<Eigen::StrictlyUpper>() = of.xx[part].transpose();
    of.xy[part] = weight * xs.transpose() * ys;
  }
  return sums;
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

/// Sums for influence weights, in camera space.
Sums InfluenceSums(const Stretch& stretch, size_t joint) {
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
  Sums sums = ErrorSums(stretch, joint, y, weight);
  sums.of.resize(2 * LinearFilter::kOutputs);
  for (size_t part = 0; part < kParts; ++part) {
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

double UsualStep_s(const std::vector<PosturePair>& pairs) {
  std::vector<double> steps;
  for (size_t i = 1; i < pairs.size(); ++i) {
    const double step_s = pairs[i].time_s - pairs[i - 1].time_s;
    if (pairs[i].clip == pairs[i - 1].clip && step_s > 0.0) steps.push_back(step_s);
  }
  if (steps.empty()) return 0.0;
  return Median(std::move(steps));
}

/// Accumulated training data, by fold and learned side of the joints.
class Learner {
 public:
  Learner(const std::vector<PosturePair>& pairs, const LinearFilterOptions& options)
      : options_(options), influences_(OfOnePerson(pairs)) {
    filter_.step_s = UsualStep_s(pairs);
    const std::vector<int> fold = AssignFolds(pairs, kFolds);
    std::vector<Posture> seen;
    for (const PosturePair& pair : pairs) seen.push_back(InCamera(pair));
    for (size_t joint = 0; joint < kJointCount; ++joint) {
      Stretch stretch;
      for (size_t i = 0; i < pairs.size(); ++i) {
        const bool follows = i > 0 && fold[i] == fold[i - 1] &&
                             Follows(pairs[i - 1], pairs[i], seen[i - 1], seen[i]);
        if (!follows || !Usable(pairs[i], joint)) {
          Add(stretch, joint, fold[i == 0 ? 0 : i - 1]);
          stretch = Stretch();
        }
        if (!Usable(pairs[i], joint)) continue;
        stretch.pairs.push_back(&pairs[i]);
        stretch.seen.push_back(seen[i]);
      }
      Add(stretch, joint, fold.back());
    }
  }

  LinearFilter Learned() {
    bool any = false;
    for (const auto output : {LinearFilter::kNow, LinearFilter::kBefore}) {
      for (size_t joint = 0; joint < kJointCount; ++joint) {
        if (LearnedSideOf(joint) == joint) Choose(output, joint);
        any = any || filter_.Knows(output, joint);
      }
    }
    return any ? filter_ : LinearFilter();
  }

 private:
  /// Held-out squared errors of one joint: of position and of second differences.
  using Left = std::array<double, kParts>;

  /// Influence weights are trained on gross errors, too.
  bool Usable(const PosturePair& pair, size_t joint) const {
    constexpr double kGross_m = 0.3;  // possibly another limb
    return pair.known[joint] > 0.0 &&
           (influences_ || pair.scale * pair.residual.position_m[joint].norm() < kGross_m);
  }

  bool Follows(const PosturePair& before, const PosturePair& now, const Posture& was,
               const Posture& is) const {
    if (before.clip != now.clip || !filter_.IsStep(now.time_s - before.time_s)) return false;
    constexpr double kElsewhere_m = 0.2;  // of the median joint: another body, or a cut
    JointArray<double> moved{};
    for (size_t i = 0; i < kJointCount; ++i)
      moved[i] = (is.position_m[i] - was.position_m[i]).norm();
    return SelectRank(std::span<double>(moved), kJointCount / 2) < kElsewhere_m;
  }

  void Add(const Stretch& stretch, size_t joint, int fold) {
    if (stretch.seen.size() < LinearFilter::kFrames + LinearFilter::kFewest) return;
    const size_t side = LearnedSideOf(joint);
    Sums& sums = fold == kNoFold ? between_[side] : sums_[static_cast<size_t>(fold)][side];
    if (influences_) {
      sums += InfluenceSums(stretch, joint);
      return;
    }
    sums += StepSums(stretch, joint, side != joint);
    const bool middle = kMirroredJoint[joint] == joint;
    if (middle) sums += StepSums(stretch, joint, true);
  }

  /// Hyperparameters of a joint: regularisation, and the weight of second differences.
  struct Hyperparameters {
    double ridge, acceleration;
  };

  const Products& MeasureOf(const Sums& sums, LinearFilter::Output output) const {
    return sums.of[influences_ ? static_cast<size_t>(output) : 0];
  }
  /// The columns of one output.
  Eigen::MatrixXd XyOf(const Products& of, size_t part, LinearFilter::Output output) const {
    if (influences_) return of.xy[part];
    return of.xy[part].middleCols<3>(3 * static_cast<Eigen::Index>(output));
  }

  Eigen::MatrixXd Solve(const Sums& sums, const Hyperparameters& parameters,
                        LinearFilter::Output output) const {
    const Products& of =
        influences_ ? sums.of[LinearFilter::kOutputs + static_cast<size_t>(output)] : sums.of[0];
    Eigen::MatrixXd a = of.xx[0] + parameters.acceleration * of.xx[1];
    a.diagonal().array() += parameters.ridge * a.diagonal().mean() + 1e-12;
    return a.llt().solve(XyOf(of, 0, output) + parameters.acceleration * XyOf(of, 1, output));
  }

  /// A joint's held-out and training sums, by fold.
  struct FoldSums {
    const Sums* held;
    Sums rest;
  };

  std::optional<Left> LeftOut(const std::vector<FoldSums>& folds, const Hyperparameters& parameters,
                              LinearFilter::Output output) const {
    Left left{};
    if (folds.size() < 2) return std::nullopt;
    for (const auto& [held, rest] : folds) {
      const Products& of = MeasureOf(*held, output);
      if (rest.rows < 10.0 * static_cast<double>(of.xx[0].rows())) return std::nullopt;
      const Eigen::MatrixXd w = Solve(rest, parameters, output);
      for (size_t part = 0; part < kParts; ++part) {
        left[part] += held->yy[part][output] - 2.0 * w.cwiseProduct(XyOf(of, part, output)).sum() +
                      w.cwiseProduct(of.xx[part] * w).sum();
      }
    }
    return left;
  }

  /// The held-out objective.
  double Objective(const Left& left) const {
    const auto log = [](double square) { return std::log(std::max(square, 0.0) + 1e-12); };
    return options_.position_share * log(left[0]) + log(left[1]);
  }

  /// Chooses the hyperparameters with the smallest held-out objective; none if LagFilter is better.
  void Choose(LinearFilter::Output output, size_t side) {
    Sums whole;
    for (const auto& of_fold : sums_) whole += of_fold[side];
    std::vector<FoldSums> folds;
    for (const auto& of_fold : sums_) {
      if (of_fold[side].rows > 0.0) folds.push_back({&of_fold[side], whole - of_fold[side]});
    }
    double least = Objective({whole.lag[0][output], whole.lag[1][output]});
    std::optional<Hyperparameters> best;
    for (const double ridge : options_.ridges) {
      for (const double acceleration : options_.accelerations) {
        const Hyperparameters parameters{ridge, acceleration};
        const auto left = LeftOut(folds, parameters, output);
        if (!left) return;
        if (Objective(*left) >= least) continue;
        least = Objective(*left);
        best = parameters;
      }
    }
    if (!best) return;
    whole += between_[side];
    filter_.weights[output][side] = Solve(whole, *best, output).cast<float>();
  }

  LinearFilterOptions options_;
  bool influences_;  // of one person: few weights generalise better
  LinearFilter filter_;
  static constexpr int kFolds = 7;
  std::array<JointArray<Sums>, kFolds> sums_;
  JointArray<Sums> between_;  // pairs in no fold
};

}  // namespace

LinearFilter LinearFilter::Learn(const std::vector<PosturePair>& pairs,
                                 const LinearFilterOptions& options) {
  if (!CanLearnOf(UsualStep_s(pairs))) return {};
  // Duplicate frames add nothing, and would split a track in two.
  const auto repeats = [](const PosturePair& before, const PosturePair& now) {
    return before.clip == now.clip && before.time_s == now.time_s;
  };
  if (std::adjacent_find(pairs.begin(), pairs.end(), repeats) == pairs.end()) {
    return Learner(pairs, options).Learned();
  }
  std::vector<PosturePair> once;
  std::unique_copy(pairs.begin(), pairs.end(), std::back_inserter(once), repeats);
  return Learner(once, options).Learned();
}

}  // namespace ossa::recon
