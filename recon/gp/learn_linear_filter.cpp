// LinearFilter::Learn. Everything that is asked of people left out, of every strength, follows from
// products of regressors and errors that are added up once.
#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "recon/filters/lag_filter_internal.h"
#include "recon/gp/linear_filter.h"

namespace ossa::recon {
namespace {

constexpr int kParts = 2;  // errors of position without their mean; their second differences
constexpr Eigen::Index kColumns = 3 * LinearFilter::kOutputs;

/// A joint's stretch of frames, one after the other, in which its truth is known.
struct Stretch {
  std::vector<const PosturePair*> pairs;
  std::vector<Posture> seen;  // in camera space
};

/// Sums over the stretches of a fold's people: x the regressors, y the errors.
struct Sums {
  std::array<Eigen::MatrixXd, kParts> xx;
  std::array<Eigen::MatrixXd, kParts> xy;  // a column an axis and output
  // Of each part and output: squares of the errors, and of what LagFilter leaves of them.
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
  const bool first = rows == 0.0;
  rows += factor * other.rows;
  for (size_t part = 0; part < kParts; ++part) {
    if (first) {
      xx[part] = Eigen::MatrixXd::Zero(other.xx[part].rows(), other.xx[part].cols());
      xy[part] = Eigen::MatrixXd::Zero(other.xy[part].rows(), other.xy[part].cols());
    }
    xx[part] += factor * other.xx[part];
    xy[part] += factor * other.xy[part];
    for (size_t o = 0; o < LinearFilter::kOutputs; ++o) {
      yy[part][o] += factor * other.yy[part][o];
      lag[part][o] += factor * other.lag[part][o];
    }
  }
}

Posture InCamera(const PosturePair& pair) {
  return Placed(Scaled(pair.observed, pair.scale), pair.placement);
}

/// Truth minus observed, metres in the body's frame, x turned round for a mirrored joint.
Eigen::Vector3d ErrorOf(const PosturePair& pair, size_t joint, bool mirrored) {
  Eigen::Vector3d error = pair.scale * pair.residual.position_m[joint];
  if (mirrored) error.x() = -error.x();
  return error;
}

Eigen::Vector3d Turned(const Eigen::Vector3d& p, double angle_rad) {
  const double c = std::cos(angle_rad), s = std::sin(angle_rad);
  return {c * p.x() + s * p.z(), p.y(), -s * p.x() + c * p.z()};
}

/// The joint's error of each output that LagFilter leaves, from frame kFewest on.
Eigen::MatrixXd LeftByLagFilter(const Stretch& stretch, size_t joint) {
  Eigen::MatrixXd left(static_cast<Eigen::Index>(stretch.seen.size()), kColumns);
  LagFilter filter;
  for (size_t f = 0; f < stretch.seen.size(); ++f) {
    const PosturePair& pair = *stretch.pairs[f];
    const PosturePair& last = *stretch.pairs[f == 0 ? 0 : f - 1];
    const auto truth = [&](size_t frame, const PosturePair& of) -> Eigen::Vector3d {
      return stretch.seen[frame].position_m[joint] +
             Turned(ErrorOf(of, joint, false), of.placement.yaw_rad);
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

Sums SumsOf(const Stretch& stretch, size_t joint, bool mirrored) {
  constexpr double kPrecise_m = 0.01;  // below it errors are noise, all the same
  const auto rows = static_cast<Eigen::Index>(stretch.seen.size()) - LinearFilter::kFewest;
  Eigen::MatrixXd x, y(rows, kColumns);
  for (Eigen::Index r = 0; r < rows; ++r) {
    const auto frame = static_cast<size_t>(r) + LinearFilter::kFewest;
    const PosturePair& now = *stretch.pairs[frame];
    const PosturePair& before = *stretch.pairs[frame - 1];
    const size_t known = std::min(frame, size_t{LinearFilter::kSteps});
    const auto window = std::span(stretch.seen).subspan(frame - known, known + 1);
    LinearFilter::Steps steps;
    steps.fill(static_cast<int>(known));
    const Eigen::VectorXf feature =
        FilterFeature(window, steps, now.placement.yaw_rad, joint, mirrored);
    if (r == 0) x.resize(rows, feature.size());
    x.row(r) = feature.transpose().cast<double>();
    const double turn = before.placement.yaw_rad - now.placement.yaw_rad;
    y.row(r).head<3>() = ErrorOf(now, joint, mirrored);
    y.row(r).tail<3>() = Turned(ErrorOf(before, joint, mirrored), mirrored ? -turn : turn);
  }
  const Eigen::MatrixXd lag = LeftByLagFilter(stretch, joint);
  const Eigen::MatrixXd centred = Part(y, 0);
  const double spread_m =
      std::sqrt(centred.leftCols<3>().squaredNorm() / static_cast<double>(rows));
  const double weight = 1.0 / (spread_m + kPrecise_m);
  Sums sums;
  sums.rows = static_cast<double>(rows);
  for (size_t part = 0; part < kParts; ++part) {
    const Eigen::MatrixXd xs = Part(x, part), ys = Part(y, part), ls = Part(lag, part);
    sums.xx[part] = Eigen::MatrixXd::Zero(x.cols(), x.cols());
    sums.xx[part].selfadjointView<Eigen::Lower>().rankUpdate(xs.transpose(), weight);
    sums.xx[part].triangularView<Eigen::StrictlyUpper>() = sums.xx[part].transpose();
    sums.xy[part] = weight * xs.transpose() * ys;
    for (Eigen::Index o = 0; o < LinearFilter::kOutputs; ++o) {
      const auto output = static_cast<size_t>(o);
      sums.yy[part][output] = weight * ys.middleCols<3>(3 * o).squaredNorm();
      sums.lag[part][output] = weight * ls.middleCols<3>(3 * o).squaredNorm();
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
  const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
  std::nth_element(steps.begin(), middle, steps.end());
  return *middle;
}

/// All that is learned from, by people and learned side of the joints.
class Learner {
 public:
  Learner(const std::vector<PosturePair>& pairs, const LinearFilterOptions& options)
      : options_(options) {
    filter_.step_s = UsualStep_s(pairs);
    std::vector<Posture> seen;
    for (const PosturePair& pair : pairs) seen.push_back(InCamera(pair));
    for (size_t joint = 0; joint < kJointCount; ++joint) {
      Stretch stretch;
      for (size_t i = 0; i < pairs.size(); ++i) {
        const bool follows = i > 0 && Follows(pairs[i - 1], pairs[i], seen[i - 1], seen[i]);
        if (!follows || !Usable(pairs[i], joint)) {
          Add(stretch, joint);
          stretch = Stretch();
        }
        if (!Usable(pairs[i], joint)) continue;
        stretch.pairs.push_back(&pairs[i]);
        stretch.seen.push_back(seen[i]);
      }
      Add(stretch, joint);
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
  /// Held-out squared errors of one joint: of position, of second differences.
  using Left = std::array<double, kParts>;

  static bool Usable(const PosturePair& pair, size_t joint) {
    constexpr double kGross_m = 0.3;  // another limb, perhaps
    return pair.known[joint] > 0.0 &&
           pair.scale * pair.residual.position_m[joint].norm() < kGross_m;
  }

  bool Follows(const PosturePair& before, const PosturePair& now, const Posture& was,
               const Posture& is) const {
    if (before.clip != now.clip || !filter_.IsStep(now.time_s - before.time_s)) return false;
    constexpr double kElsewhere_m = 0.2;  // in the median joint: another body, or a cut
    std::array<double, kJointCount> moved{};
    for (size_t i = 0; i < kJointCount; ++i)
      moved[i] = (is.position_m[i] - was.position_m[i]).norm();
    std::nth_element(moved.begin(), moved.begin() + kJointCount / 2, moved.end());
    return moved[kJointCount / 2] < kElsewhere_m;
  }

  void Add(const Stretch& stretch, size_t joint) {
    if (stretch.seen.size() < LinearFilter::kFrames + LinearFilter::kFewest) return;
    const size_t side = LearnedSideOf(joint);
    const int person = people_.try_emplace(stretch.pairs[0]->group, people_.size()).first->second;
    Sums& sums = sums_[static_cast<size_t>(person) % kFolds][side];
    sums += SumsOf(stretch, joint, side != joint);
    const bool middle = kMirroredJoint[joint] == static_cast<int>(joint);
    if (middle) sums += SumsOf(stretch, joint, true);
  }

  static Eigen::MatrixXd Solve(const Sums& sums, double ridge, double acceleration,
                               LinearFilter::Output output) {
    Eigen::MatrixXd a = sums.xx[0] + acceleration * sums.xx[1];
    a.diagonal().array() += ridge * a.diagonal().mean() + 1e-12;
    const Eigen::MatrixXd b = sums.xy[0] + acceleration * sums.xy[1];
    return a.llt().solve(b.middleCols<3>(3 * static_cast<Eigen::Index>(output)));
  }

  std::optional<Left> LeftOut(const Sums& whole, size_t side, double ridge, double acceleration,
                              LinearFilter::Output output) const {
    Left left{};
    int tested = 0;
    for (const auto& of_fold : sums_) {
      const Sums& held = of_fold[side];
      if (held.rows == 0.0) continue;
      const Sums rest = whole - held;
      if (rest.rows < 10.0 * static_cast<double>(rest.xx[0].rows())) return std::nullopt;
      const Eigen::MatrixXd w = Solve(rest, ridge, acceleration, output);
      const auto columns = 3 * static_cast<Eigen::Index>(output);
      for (size_t part = 0; part < kParts; ++part) {
        left[part] += held.yy[part][output] -
                      2.0 * w.cwiseProduct(held.xy[part].middleCols<3>(columns)).sum() +
                      w.cwiseProduct(held.xx[part] * w).sum();
      }
      ++tested;
    }
    if (tested < 2) return std::nullopt;
    return left;
  }

  /// What is to be least on people left out.
  double Badness(const Left& left) const {
    const auto log = [](double square) { return std::log(std::max(square, 0.0) + 1e-12); };
    return options_.position_share * log(left[0]) + log(left[1]);
  }

  /// The strength that is least bad on people left out; none where LagFilter does better.
  void Choose(LinearFilter::Output output, size_t side) {
    Sums whole;
    for (const auto& of_fold : sums_) whole += of_fold[side];
    double least = Badness({whole.lag[0][output], whole.lag[1][output]});
    std::optional<std::pair<double, double>> best;
    for (const double ridge : options_.ridges) {
      for (const double acceleration : options_.accelerations) {
        const auto left = LeftOut(whole, side, ridge, acceleration, output);
        if (!left) return;
        if (Badness(*left) >= least) continue;
        least = Badness(*left);
        best = {ridge, acceleration};
      }
    }
    if (!best) return;
    filter_.weights[output][side] = Solve(whole, best->first, best->second, output).cast<float>();
  }

  LinearFilterOptions options_;
  LinearFilter filter_;
  std::map<int, int> people_;  // their numbers, in the order in which they come
  // People by turns.
  static constexpr size_t kFolds = 7;
  std::array<std::array<Sums, kJointCount>, kFolds> sums_;
};

}  // namespace

LinearFilter LinearFilter::Learn(const std::vector<PosturePair>& pairs,
                                 const LinearFilterOptions& options) {
  if (UsualStep_s(pairs) == 0.0) return {};
  return Learner(pairs, options).Learned();
}

}  // namespace ossa::recon
