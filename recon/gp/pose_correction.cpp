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
    feature[at + 3] = static_cast<float>(length);
  }
  return feature;
}

PoseCorrection PoseCorrection::Learn(const std::vector<PosturePair>& all_pairs,
                                     const PoseCorrectionOptions& options) {
  std::vector<PosturePair> pairs = Thinned(all_pairs, options.most_pairs);
  const size_t single = pairs.size();
  for (size_t i = 0; i < single; ++i) pairs.push_back(Mirrored(pairs[i]));
  const auto n = static_cast<Eigen::Index>(pairs.size());
  Eigen::MatrixXf x(4 * static_cast<Eigen::Index>(kLines.size()), n);
  Eigen::MatrixXf y(n, kPostureDims);
  for (Eigen::Index i = 0; i < n; ++i) {
    x.col(i) = CorrectionFeature(pairs[static_cast<size_t>(i)].observed);
    y.row(i) = VectorOf(pairs[static_cast<size_t>(i)].residual).transpose();
  }
  std::vector<Eigen::Index> order(static_cast<size_t>(n));
  std::iota(order.begin(), order.end(), 0);
  std::mt19937_64 random(options.seed);
  for (size_t i = order.size() - 1; i > 0; --i) std::swap(order[i], order[random() % (i + 1)]);

  PoseCorrection out;
  const Eigen::Index m = std::min<Eigen::Index>(options.centres, n);
  out.width_ = options.width;
  out.centres_.resize(x.rows(), m);
  for (Eigen::Index c = 0; c < m; ++c) out.centres_.col(c) = x.col(order[static_cast<size_t>(c)]);
  out.weights_ = Eigen::MatrixXf::Zero(m, kPostureDims);
  out.mean_ = Eigen::VectorXf::Zero(kPostureDims);
  const Eigen::MatrixXf inner = Kernel(out.centres_, out.centres_, options.width);
  const Eigen::MatrixXf cross = Kernel(out.centres_, x, options.width);  // m x n
  for (const auto& [mask, joints] : JointsByMask(pairs)) {
    Eigen::MatrixXf k(m, n);
    Eigen::MatrixXf targets(n, 3 * static_cast<Eigen::Index>(joints.size()));
    Eigen::Index rows = 0;
    for (Eigen::Index i = 0; i < n; ++i) {
      if (!mask[static_cast<size_t>(i)]) continue;
      k.col(rows) = cross.col(i);
      for (size_t j = 0; j < joints.size(); ++j) {
        targets.block<1, 3>(rows, 3 * static_cast<Eigen::Index>(j)) =
            y.block<1, 3>(i, 3 * static_cast<Eigen::Index>(joints[j]));
      }
      ++rows;
    }
    const Eigen::RowVectorXf mean = targets.topRows(rows).colwise().mean();
    targets.topRows(rows).rowwise() -= mean;
    Eigen::MatrixXd a = (k.leftCols(rows) * k.leftCols(rows).transpose()).cast<double>();
    a += options.noise_ratio * inner.cast<double>();
    a.diagonal().array() += 1e-4 * a.diagonal().mean();
    const Eigen::MatrixXd b = (k.leftCols(rows) * targets.topRows(rows)).cast<double>();
    const Eigen::MatrixXf solved = a.llt().solve(b).cast<float>();
    for (size_t j = 0; j < joints.size(); ++j) {
      const auto to = 3 * static_cast<Eigen::Index>(joints[j]);
      const auto from = 3 * static_cast<Eigen::Index>(j);
      out.weights_.middleCols<3>(to) = solved.middleCols<3>(from);
      out.mean_.segment<3>(to) = mean.segment<3>(from).transpose();
    }
  }
  return out;
}

Posture PoseCorrection::Offsets(const Posture& scaled) const {
  if (empty()) return {};
  const Eigen::VectorXf feature = CorrectionFeature(scaled);
  const Eigen::VectorXf k = ((centres_.colwise() - feature).colwise().squaredNorm().array() *
                             static_cast<float>(-0.5 / (width_ * width_)))
                                .exp()
                                .matrix()
                                .transpose();
  const PostureVector offsets = mean_ + weights_.transpose() * k;
  return PostureOf(offsets);
}

}  // namespace ossa::recon
