#include "recon/gp/pose_correction.h"

#include <Eigen/Cholesky>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <random>

#include "recon/database/posture_database.h"

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
constexpr double kDirectionScale = 0.3;  // a turned bone moves its end by about as many metres
// A bone seen 10 cm too short tells as much as one turned by 60 degrees. Best of 1, 3, 5 on people
// left out (UI-PRMD).
constexpr double kLengthScale = 3.0;

Eigen::MatrixXf Kernel(const Eigen::MatrixXf& a, const Eigen::MatrixXf& b, double width) {
  Eigen::MatrixXf d = -2.0F * a.transpose() * b;
  d.colwise() += a.colwise().squaredNorm().transpose();
  d.rowwise() += b.colwise().squaredNorm();
  return (d.array().max(0.0F) * static_cast<float>(-0.5 / (width * width))).exp().matrix();
}

/// Joints whose truth is known in exactly the same pairs share one set of normal equations.
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

/// Kernel values with the centres, then the feature itself: samples x (centres + features).
Eigen::MatrixXf Regressors(const Eigen::MatrixXf& centres, const Eigen::MatrixXf& x, double width) {
  Eigen::MatrixXf out(x.cols(), centres.cols() + x.rows());
  out.leftCols(centres.cols()) = Kernel(x, centres, width);
  out.rightCols(x.rows()) = x.transpose();
  return out;
}

struct Samples {
  Eigen::MatrixXf features;  // features x n
  Eigen::MatrixXf residual;  // n x 60
  std::vector<PosturePair> pairs;
};

Samples SamplesOf(std::vector<PosturePair> pairs) {
  Samples s;
  const size_t single = pairs.size();
  for (size_t i = 0; i < single; ++i) pairs.push_back(Mirrored(pairs[i]));
  const auto n = static_cast<Eigen::Index>(pairs.size());
  s.features.resize(4 * static_cast<Eigen::Index>(kLines.size()), n);
  s.residual.resize(n, kPostureDims);
  for (Eigen::Index i = 0; i < n; ++i) {
    s.features.col(i) = CorrectionFeature(pairs[static_cast<size_t>(i)].observed);
    s.residual.row(i) = VectorOf(pairs[static_cast<size_t>(i)].residual).transpose();
  }
  s.pairs = std::move(pairs);
  return s;
}

Eigen::MatrixXf Centres(const Eigen::MatrixXf& features, int count, uint64_t seed) {
  std::vector<Eigen::Index> order(static_cast<size_t>(features.cols()));
  std::iota(order.begin(), order.end(), 0);
  std::mt19937_64 random(seed);
  for (size_t i = order.size() - 1; i > 0; --i) std::swap(order[i], order[random() % (i + 1)]);
  const Eigen::Index m = std::min<Eigen::Index>(count, features.cols());
  Eigen::MatrixXf centres(features.rows(), m);
  for (Eigen::Index c = 0; c < m; ++c) {
    centres.col(c) = features.col(order[static_cast<size_t>(c)]);
  }
  return centres;
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
      const auto parent = static_cast<size_t>(kJointParent[i]);
      if (pair.known[i] == 0.0 || pair.known[parent] == 0.0) continue;
      const Eigen::Vector3d bone = pair.observed.position_m[i] + pair.residual.position_m[i] -
                                   pair.observed.position_m[parent] -
                                   pair.residual.position_m[parent];
      for (const size_t side : {i, static_cast<size_t>(kMirroredJoint[i])}) {
        sum[side] += bone.norm() / StandardBoneLengths()[i];
        count[side] += 1.0;
      }
    }
  }
  for (size_t i = 1; i < kJointCount; ++i) sum[i] = count[i] > 0.0 ? sum[i] / count[i] : 0.0;
  return sum;
}

struct LinearFit {
  Eigen::RowVectorXf mean;
  Eigen::MatrixXf weights;  // regressors x outputs
};

/// Least squares with a prior, then again with every sample weighed by the inverse of its error.
LinearFit RobustFit(const Eigen::MatrixXf& k, const Eigen::MatrixXf& targets,
                    const Eigen::MatrixXd& prior, const PoseCorrectionOptions& options) {
  constexpr float kPrecise_m = 0.03F;  // below it errors are noise, all the same
  Eigen::VectorXf sample = Eigen::VectorXf::Ones(k.rows());
  LinearFit fit;
  for (int round = 0; round <= options.reweighings; ++round) {
    fit.mean = sample.transpose() * targets / sample.sum();
    const Eigen::MatrixXf centred = targets.rowwise() - fit.mean;
    const Eigen::MatrixXf weighed = k.array().colwise() * sample.array();
    Eigen::MatrixXd a = (k.transpose() * weighed).cast<double>() + options.noise_ratio * prior;
    a.diagonal().array() += 1e-4 * a.diagonal().mean();
    const Eigen::MatrixXd b = (weighed.transpose() * centred).cast<double>();
    fit.weights = a.llt().solve(b).cast<float>();
    if (round == options.reweighings) break;
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

/// Pairs without a gross error; all of them where hardly any is left.
std::vector<PosturePair> Sound(const std::vector<PosturePair>& pairs, double gross_m) {
  std::vector<PosturePair> sound;
  for (const PosturePair& pair : pairs) {
    if (pair.worst_m < gross_m) sound.push_back(pair);
  }
  return sound.size() >= 10 ? sound : pairs;
}

}  // namespace

// Subset of regressors (Rasmussen & Williams 2006, eq. 8.13) beside a linear model: the prior of
// the kernel's weights is the centres' own kernel matrix, that of the linear ones is unit.
PoseCorrection PoseCorrection::Fit(const std::vector<PosturePair>& pairs,
                                   const PoseCorrectionOptions& options) {
  const Samples samples = SamplesOf(pairs);
  PoseCorrection out;
  out.width_ = options.width;
  out.centres_ = Centres(samples.features, options.centres, options.seed);
  const Eigen::Index m = out.centres_.cols(), all = m + samples.features.rows();
  out.weights_ = Eigen::MatrixXf::Zero(all, kPostureDims);
  out.mean_ = Eigen::VectorXf::Zero(kPostureDims);
  Eigen::MatrixXd prior = Eigen::MatrixXd::Identity(all, all);
  prior.topLeftCorner(m, m) = Kernel(out.centres_, out.centres_, options.width).cast<double>();
  const Eigen::MatrixXf regressors = Regressors(out.centres_, samples.features, options.width);
  for (const auto& [mask, joints] : JointsByMask(samples.pairs)) {
    const Eigen::MatrixXf k = MaskedRows(regressors, mask);
    const Eigen::MatrixXf residual = MaskedRows(samples.residual, mask);
    Eigen::MatrixXf targets(k.rows(), 3 * static_cast<Eigen::Index>(joints.size()));
    for (size_t j = 0; j < joints.size(); ++j) {
      targets.middleCols<3>(3 * static_cast<Eigen::Index>(j)) =
          residual.middleCols<3>(3 * static_cast<Eigen::Index>(joints[j]));
    }
    const auto [mean, solved] = RobustFit(k, targets, prior, options);
    for (size_t j = 0; j < joints.size(); ++j) {
      const auto to = 3 * static_cast<Eigen::Index>(joints[j]);
      const auto from = 3 * static_cast<Eigen::Index>(j);
      out.weights_.middleCols<3>(to) = solved.middleCols<3>(from);
      out.mean_.segment<3>(to) = mean.segment<3>(from).transpose();
    }
  }
  return out;
}

JointWeights PoseCorrection::HeldOutGains(const std::vector<PosturePair>& pairs,
                                          const PoseCorrectionOptions& options) {
  // The gain that minimises the squared error on pairs left out, g = sum(y o) / sum(o o). Runs, not
  // single pairs, are left out: neighbours in time are nearly the same.
  JointWeights agree{}, square{}, gains{};
  const auto folds = static_cast<size_t>(options.folds);
  for (size_t fold = 0; fold < folds; ++fold) {
    const size_t begin = fold * pairs.size() / folds, end = (fold + 1) * pairs.size() / folds;
    std::vector<PosturePair> rest(pairs.begin(), pairs.begin() + static_cast<ptrdiff_t>(begin));
    rest.insert(rest.end(), pairs.begin() + static_cast<ptrdiff_t>(end), pairs.end());
    if (rest.empty() || begin == end) continue;
    const PoseCorrection fit = Fit(rest, options);
    for (size_t i = begin; i < end; ++i) {
      const Posture offsets = fit.Offsets(pairs[i].observed);
      for (size_t j = 0; j < kJointCount; ++j) {
        if (pairs[i].known[j] == 0.0) continue;
        agree[j] += offsets.position_m[j].dot(pairs[i].residual.position_m[j]);
        square[j] += offsets.position_m[j].squaredNorm();
      }
    }
  }
  for (size_t j = 0; j < kJointCount; ++j) {
    const auto m = static_cast<size_t>(kMirroredJoint[j]);
    const double total = square[j] + square[m];
    const double held = total > 0.0 ? (agree[j] + agree[m]) / total : 0.0;
    // What holds by less than half differs between people more than it is theirs in common.
    constexpr double kLeastGain = 0.5;
    gains[j] = held < kLeastGain ? 0.0 : std::min(held, 1.0);
  }
  return gains;
}

PoseCorrection PoseCorrection::Learn(const std::vector<PosturePair>& all_pairs,
                                     const PoseCorrectionOptions& options) {
  const std::vector<PosturePair> pairs =
      Thinned(Sound(all_pairs, options.gross_m), options.most_pairs);
  PoseCorrection out = Fit(pairs, options);
  out.proportion_ = TrueProportions(pairs);
  if (options.folds < 2 || out.empty()) return out;
  constexpr size_t kForGains = 4000;  // a gain is one number: a few thousand pairs fix it
  PoseCorrectionOptions quick = options;
  quick.centres = std::min(options.centres, 200);
  const JointWeights gains = HeldOutGains(Thinned(pairs, kForGains), quick);
  for (size_t j = 0; j < kJointCount; ++j) {
    const auto gain = static_cast<float>(gains[j]);
    out.weights_.middleCols<3>(3 * static_cast<Eigen::Index>(j)) *= gain;
    out.mean_.segment<3>(3 * static_cast<Eigen::Index>(j)) *= gain;
  }
  return out;
}

Posture PoseCorrection::Offsets(const Posture& scaled) const {
  if (empty()) return {};
  const Eigen::VectorXf feature = CorrectionFeature(scaled);
  const Eigen::RowVectorXf k = Regressors(centres_, feature, width_);
  const PostureVector offsets = mean_ + weights_.transpose() * k.transpose();
  return PostureOf(offsets);
}

}  // namespace ossa::recon
