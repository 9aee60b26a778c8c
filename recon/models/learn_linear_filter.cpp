// LinearFilter::Learn. All held-out errors, for any ridge strength, are computed from products of
// regressors and errors that are accumulated once.
#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>

#include "depth/base/statistics.h"
#include "recon/models/filter_sums_internal.h"
#include "recon/models/linear_filter.h"

namespace ossa::recon {
namespace {

Posture InCamera(const PosturePair& pair) {
  return Placed(Scaled(pair.observed, pair.scale), pair.placement);
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
  using Left = std::array<double, kErrorParts>;

  /// Influence weights are trained on gross errors, too.
  bool Usable(const PosturePair& pair, size_t joint) const {
    constexpr double kGross_m = 0.3;  // by hand: possibly another limb
    return pair.known[joint] > 0.0 &&
           (influences_ || pair.scale * pair.residual.position_m[joint].norm() < kGross_m);
  }

  bool Follows(const PosturePair& before, const PosturePair& now, const Posture& was,
               const Posture& is) const {
    if (before.clip != now.clip || !filter_.IsStep(now.time_s - before.time_s)) return false;
    constexpr double kElsewhere_m = 0.2;  // by hand, of the median joint: another body, or a cut
    JointArray<double> moved{};
    for (size_t i = 0; i < kJointCount; ++i)
      moved[i] = (is.position_m[i] - was.position_m[i]).norm();
    return SelectRank(std::span<double>(moved), kJointCount / 2) < kElsewhere_m;
  }

  void Add(const Stretch& stretch, size_t joint, int fold) {
    if (stretch.seen.size() < LinearFilter::kFrames + LinearFilter::kFewest) return;
    const size_t side = LearnedSideOf(joint);
    FilterSums& sums = fold == kNoFold ? between_[side] : sums_[static_cast<size_t>(fold)][side];
    if (influences_) {
      sums += SumForInfluences(stretch, joint);
      return;
    }
    sums += SumForSteps(stretch, joint, side != joint);
    const bool middle = kMirroredJoint[joint] == joint;
    if (middle) sums += SumForSteps(stretch, joint, true);
  }

  /// Hyperparameters of a joint: regularisation, and the weight of second differences.
  struct Hyperparameters {
    double ridge, acceleration;
  };

  const Products& MeasureOf(const FilterSums& sums, LinearFilter::Output output) const {
    return sums.of[influences_ ? static_cast<size_t>(output) : 0];
  }
  /// The columns of one output.
  Eigen::MatrixXd XyOf(const Products& of, size_t part, LinearFilter::Output output) const {
    if (influences_) return of.xy[part];
    return of.xy[part].middleCols<3>(3 * static_cast<Eigen::Index>(output));
  }

  Eigen::MatrixXd Solve(const FilterSums& sums, const Hyperparameters& parameters,
                        LinearFilter::Output output) const {
    const Products& of =
        influences_ ? sums.of[LinearFilter::kOutputs + static_cast<size_t>(output)] : sums.of[0];
    Eigen::MatrixXd a = of.xx[0] + parameters.acceleration * of.xx[1];
    a.diagonal().array() += parameters.ridge * a.diagonal().mean() + 1e-12;
    return a.llt().solve(XyOf(of, 0, output) + parameters.acceleration * XyOf(of, 1, output));
  }

  /// A joint's held-out and training sums, by fold.
  struct FoldSums {
    const FilterSums* held;
    FilterSums rest;
  };

  std::optional<Left> LeftOut(const std::vector<FoldSums>& folds, const Hyperparameters& parameters,
                              LinearFilter::Output output) const {
    Left left{};
    if (folds.size() < 2) return std::nullopt;
    for (const auto& [held, rest] : folds) {
      const Products& of = MeasureOf(*held, output);
      if (rest.rows < 10.0 * static_cast<double>(of.xx[0].rows())) return std::nullopt;
      const Eigen::MatrixXd w = Solve(rest, parameters, output);
      for (size_t part = 0; part < kErrorParts; ++part) {
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
    FilterSums whole;
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
  static constexpr int kFolds = 7;  // by hand
  std::array<JointArray<FilterSums>, kFolds> sums_;
  JointArray<FilterSums> between_;  // pairs in no fold
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
