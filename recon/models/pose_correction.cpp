#include "recon/models/pose_correction.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>

#include "depth/base/train_interrupted.h"
#include "recon/database/posture_database.h"
#include "recon/models/error_gains_internal.h"
#include "recon/models/local_mixture.h"

namespace ossa::recon {
namespace {

// Bones (from, to) of trunk and limbs, and the lines across shoulders and hips.
constexpr std::array<std::pair<int, int>, 15> kLines = {{{0, 1},
                                                         {1, 2},
                                                         {2, 3},
                                                         {4, 5},
                                                         {5, 6},
                                                         {8, 9},
                                                         {9, 10},
                                                         {12, 13},
                                                         {13, 14},
                                                         {16, 17},
                                                         {17, 18},
                                                         {8, 4},
                                                         {16, 12},
                                                         {2, 4},
                                                         {2, 8}}};
// Constants: chosen on left-out people of UI-PRMD where stated, else by hand.

constexpr double kDirectionScale = 0.3;  // the end of a rotated bone moves by about as many metres
// A bone 10 cm too short weighs as much as one rotated by 60 degrees. Best of 1, 3, 5 on held-out
// people (UI-PRMD).
constexpr double kLengthScale = 3.0;

Eigen::MatrixXf Kernel(const Eigen::MatrixXf& a, const Eigen::MatrixXf& b, double width) {
  Eigen::MatrixXf d = -2.0F * a.transpose() * b;
  d.colwise() += a.colwise().squaredNorm().transpose();
  d.rowwise() += b.colwise().squaredNorm();
  return (d.array().max(0.0F) * static_cast<float>(-0.5 / (width * width))).exp().matrix();
}

/// Groups joints with known truth in the same pairs: they share normal equations.
std::map<std::vector<bool>, std::vector<size_t>> JointsByMask(
    const std::vector<PosturePair>& pairs) {
  std::map<std::vector<bool>, std::vector<size_t>> groups;
  for (size_t joint = 0; joint < kJointCount; ++joint) {
    std::vector<bool> mask;
    bool any = false;
    for (const PosturePair& pair : pairs) {
      mask.push_back(pair.known[joint] > 0.0);
      any = any || mask.back();
    }
    if (any) groups[mask].push_back(joint);
  }
  return groups;
}

}  // namespace

Eigen::VectorXf CorrectionFeature(const Posture& scaled) {
  Eigen::VectorXf feature(4 * static_cast<Eigen::Index>(kLines.size()));
  for (size_t k = 0; k < kLines.size(); ++k) {
    const Eigen::Vector3d line = scaled.position_m[static_cast<size_t>(kLines[k].second)] -
                                 scaled.position_m[static_cast<size_t>(kLines[k].first)];
    const double length = std::max(line.norm(), 1e-3);
    const auto at = static_cast<Eigen::Index>(4 * k);
    feature.segment<3>(at) = (kDirectionScale / length * line).cast<float>();
    feature[at + 3] = static_cast<float>(kLengthScale * length);
  }
  return feature;
}

namespace {

/// Kernel values at the centres, followed by the feature itself: samples x (centres + features).
Eigen::MatrixXf Regressors(const Eigen::MatrixXf& centres, const Eigen::MatrixXf& x, double width) {
  Eigen::MatrixXf out(x.cols(), centres.cols() + x.rows());
  out.leftCols(centres.cols()) = Kernel(x, centres, width);
  out.rightCols(x.rows()) = x.transpose();
  return out;
}

}  // namespace

/// Training data, prepared for every choice of width and noise.
struct PoseCorrection::Samples {
  Eigen::MatrixXf features;  // features x n
  Eigen::MatrixXf residual;  // n x 60
  std::vector<PosturePair> pairs;
  Eigen::MatrixXf centres;
};

namespace {

/// Means of K-means clusters with ten members or more: nobody's individual postures.
Eigen::MatrixXf Centres(const Eigen::MatrixXf& features, int count, uint64_t seed) {
  constexpr Eigen::Index kFewestMembers = 10, kMostRows = 12000;
  constexpr int kRounds = 8;
  const Eigen::Index rows = std::min(features.cols(), kMostRows);
  Eigen::MatrixXd x(rows, features.rows());
  for (Eigen::Index i = 0; i < rows; ++i) {
    x.row(i) = features.col(i * features.cols() / rows).transpose().cast<double>();
  }
  const auto regions = static_cast<int>(std::min<Eigen::Index>(count, rows / (2 * kFewestMembers)));
  if (regions < 1) return Eigen::MatrixXf(features.rows(), 0);
  const std::vector<int> region = KMeans(x, regions, seed, kRounds);
  Eigen::MatrixXd sums = Eigen::MatrixXd::Zero(features.rows(), regions);
  std::vector<Eigen::Index> members(static_cast<size_t>(regions), 0);
  for (Eigen::Index i = 0; i < rows; ++i) {
    const int r = region[static_cast<size_t>(i)];
    sums.col(r) += x.row(i).transpose();
    ++members[static_cast<size_t>(r)];
  }
  Eigen::MatrixXf centres(features.rows(), regions);
  Eigen::Index kept = 0;
  for (int r = 0; r < regions; ++r) {
    const Eigen::Index n = members[static_cast<size_t>(r)];
    if (n < kFewestMembers) continue;
    centres.col(kept++) = (sums.col(r) / static_cast<double>(n)).cast<float>();
  }
  return centres.leftCols(kept);
}

/// Rows of a matrix for which the mask is set.
Eigen::MatrixXf MaskedRows(const Eigen::MatrixXf& m, const std::vector<bool>& mask) {
  Eigen::MatrixXf out(std::count(mask.begin(), mask.end(), true), m.cols());
  for (Eigen::Index i = 0, row = 0; i < m.rows(); ++i) {
    if (mask[static_cast<size_t>(i)]) out.row(row++) = m.row(i);
  }
  return out;
}

BoneLengths TrueProportions(const std::vector<PosturePair>& pairs) {
  BoneLengths sum{}, count{};
  for (const PosturePair& pair : pairs) {
    for (size_t i = 1; i < kJointCount; ++i) {
      const auto parent = ParentOf(i);
      if (pair.known[i] == 0.0 || pair.known[parent] == 0.0) continue;
      const Eigen::Vector3d bone = pair.observed.position_m[i] + pair.residual.position_m[i] -
                                   pair.observed.position_m[parent] -
                                   pair.residual.position_m[parent];
      for (const size_t side : {i, kMirroredJoint[i]}) {
        sum[side] += bone.norm() / StandardBoneLengths()[i];
        count[side] += 1.0;
      }
    }
  }
  BoneLengths proportions{};
  for (size_t i = 1; i < kJointCount; ++i) {
    const double mean = count[i] > 0.0 ? sum[i] / count[i] : 0.0;
    proportions[i] = mean < PoseCorrection::kMostProportion ? mean : 0.0;
  }
  return proportions;
}

struct LinearFit {
  Eigen::RowVectorXf mean;
  Eigen::MatrixXf weights;  // regressors x outputs
};

/// Regularised least squares, repeated with samples weighted by the inverse of their error.
/// `prior`: of the weights, times the ratio of noise to signal.
LinearFit RobustFit(const Eigen::MatrixXf& k, const Eigen::MatrixXf& targets,
                    const Eigen::MatrixXd& prior, int reweighings) {
  constexpr float kPrecise_m = 0.03F;  // errors below are noise and get equal weight
  Eigen::VectorXf sample = Eigen::VectorXf::Ones(k.rows());
  LinearFit fit;
  for (int round = 0; round <= reweighings; ++round) {
    fit.mean = sample.transpose() * targets / sample.sum();
    const Eigen::MatrixXf centred = targets.rowwise() - fit.mean;
    const Eigen::MatrixXf weighed = k.array().colwise() * sample.array();
    Eigen::MatrixXd a = (k.transpose() * weighed).cast<double>() + prior;
    a.diagonal().array() += 1e-4 * a.diagonal().mean();
    const Eigen::MatrixXd b = (weighed.transpose() * centred).cast<double>();
    fit.weights = a.llt().solve(b).cast<float>();
    if (round == reweighings) break;
    const Eigen::MatrixXf left = centred - k * fit.weights;
    Eigen::VectorXf error_m = Eigen::VectorXf::Zero(k.rows());
    for (Eigen::Index j = 0; j < left.cols(); j += 3) {
      error_m += left.middleCols<3>(j).rowwise().norm() * (3.0F / static_cast<float>(left.cols()));
    }
    sample = (error_m.array() + kPrecise_m).inverse();
    sample *= static_cast<float>(k.rows()) / sample.sum();
  }
  return fit;
}

}  // namespace

PoseCorrection::Samples PoseCorrection::MakeSamples(std::vector<PosturePair> pairs,
                                                    const PoseCorrectionOptions& options) {
  Samples s;
  const size_t single = pairs.size();
  for (size_t i = 0; i < single; ++i) pairs.push_back(Mirrored(pairs[i]));
  const auto n = static_cast<Eigen::Index>(pairs.size());
  s.features.resize(4 * static_cast<Eigen::Index>(kLines.size()), n);
  s.residual.resize(n, kPostureDims);
  for (Eigen::Index i = 0; i < n; ++i) {
    s.features.col(i) = CorrectionFeature(pairs[static_cast<size_t>(i)].observed);
    s.residual.row(i) = ToVector(pairs[static_cast<size_t>(i)].residual).transpose();
  }
  s.pairs = std::move(pairs);
  s.centres = Centres(s.features, options.centres, options.seed);
  return s;
}

// Subset of regressors (Rasmussen & Williams 2006, sec. 8.3.1) plus a linear model: the prior of
// the kernel weights is the centres' own kernel matrix, that of the linear ones is the identity.
PoseCorrection PoseCorrection::Fit(const Samples& samples, double width, double noise_ratio,
                                   const PoseCorrectionOptions& options) {
  PoseCorrection out;
  out.width = width;
  out.centres = samples.centres;
  const Eigen::Index m = out.centres.cols(), all = m + samples.features.rows();
  out.weights = Eigen::MatrixXf::Zero(all, kPostureDims);
  out.mean = Eigen::VectorXf::Zero(kPostureDims);
  Eigen::MatrixXd prior = Eigen::MatrixXd::Identity(all, all);
  prior.topLeftCorner(m, m) = Kernel(out.centres, out.centres, width).cast<double>();
  prior *= noise_ratio;
  const Eigen::MatrixXf regressors = Regressors(out.centres, samples.features, width);
  for (const auto& [mask, joints] : JointsByMask(samples.pairs)) {
    const Eigen::MatrixXf k = MaskedRows(regressors, mask);
    const Eigen::MatrixXf residual = MaskedRows(samples.residual, mask);
    Eigen::MatrixXf targets(k.rows(), 3 * static_cast<Eigen::Index>(joints.size()));
    for (size_t j = 0; j < joints.size(); ++j) {
      targets.middleCols<3>(FirstCoordinate(j)) =
          residual.middleCols<3>(FirstCoordinate(joints[j]));
    }
    const auto [mean, solved] = RobustFit(k, targets, prior, options.reweighings);
    for (size_t j = 0; j < joints.size(); ++j) {
      const auto to = FirstCoordinate(joints[j]);
      const auto from = FirstCoordinate(j);
      out.weights.middleCols<3>(to) = solved.middleCols<3>(from);
      out.mean.segment<3>(to) = mean.segment<3>(from).transpose();
    }
  }
  return out;
}

PoseCorrection::HeldOut PoseCorrection::LeaveOut(const std::vector<PosturePair>& pairs,
                                                 const std::vector<int>& fold,
                                                 const std::map<int, Samples>& rest, double width,
                                                 double noise_ratio,
                                                 const PoseCorrectionOptions& options) {
  std::vector<Posture> offsets(pairs.size());
  for (const auto& [held, samples] : rest) {
    const PoseCorrection fit = Fit(samples, width, noise_ratio, options);
    for (size_t i = 0; i < pairs.size(); ++i) {
      if (fold[i] == held) offsets[i] = fit.Offsets(pairs[i].observed);
    }
  }
  HeldOut out;
  out.gains = ComputeGains(pairs, fold, offsets);
  // Errors common to blocks of one person may be specific to the person: half the gain.
  constexpr double kOfOnePerson = 0.5;
  if (OfOnePerson(pairs)) {
    for (double& gain : out.gains) gain *= kOfOnePerson;
  }
  out.error_m = ErrorLeft(pairs, fold, offsets, out.gains);
  return out;
}

PoseCorrection PoseCorrection::Learn(const std::vector<PosturePair>& all_pairs,
                                     const PoseCorrectionOptions& options) {
  const std::vector<PosturePair> pairs =
      Thinned(WithoutGrossErrors(all_pairs, options.gross_m), options.most_pairs);
  constexpr size_t kForChoice = 2000;  // enough pairs to choose a few numbers
  const std::vector<PosturePair> some = Thinned(pairs, kForChoice);
  PoseCorrectionOptions quick = options;
  quick.centres = std::min(options.centres, 100);
  const std::vector<int> fold = AssignFolds(some, options.folds);
  std::map<int, Samples> rest;  // training data of each fold
  for (int held = 0; held < options.folds; ++held) {
    std::vector<PosturePair> others;
    for (size_t i = 0; i < some.size(); ++i) {
      if (fold[i] != held && fold[i] != kNoFold) others.push_back(some[i]);
    }
    const bool nobody = std::find(fold.begin(), fold.end(), held) == fold.end();
    if (!nobody && !others.empty()) rest.emplace(held, MakeSamples(std::move(others), quick));
  }
  double width = options.widths.front(), noise_ratio = options.noise_ratios.front();
  std::optional<HeldOut> best;
  for (const double w : options.widths) {
    for (const double n : options.noise_ratios) {
      if (options.stop && options.stop()) throw TrainInterrupted("interrupted");
      const HeldOut held = LeaveOut(some, fold, rest, w, n, quick);
      if (best && held.error_m >= best->error_m) continue;
      best = held;
      width = w;
      noise_ratio = n;
    }
  }
  PoseCorrection out = Fit(MakeSamples(pairs, options), width, noise_ratio, options);
  out.proportions = TrueProportions(pairs);
  for (size_t j = 0; j < kJointCount; ++j) {
    const auto gain = static_cast<float>(best->gains[j]);
    out.weights.middleCols<3>(FirstCoordinate(j)) *= gain;
    out.mean.segment<3>(FirstCoordinate(j)) *= gain;
  }
  return out;
}

Posture PoseCorrection::Offsets(const Posture& scaled) const {
  if (empty()) return {};
  const Eigen::VectorXf feature = CorrectionFeature(scaled);
  const Eigen::RowVectorXf k = Regressors(centres, feature, width);
  const PostureVector offsets = mean + weights.transpose() * k.transpose();
  return ToPosture(offsets);
}

}  // namespace ossa::recon
