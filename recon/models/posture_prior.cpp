#include "recon/models/posture_prior.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "depth/base/checksummed_container.h"
#include "depth/base/error.h"
#include "depth/base/naming_the_file.h"
#include "depth/base/perceptron/perceptron_file.h"

namespace ossa::recon {
namespace {

using BoneMatrix = Eigen::Matrix<double, kBoneDims, kBoneDims>;

constexpr ContainerFormat kPriorFormat = {
    {'O', 'S', 'S', 'A', 'P', 'R', '0', '0'}, PosturePrior::kVersion, "posture prior"};
// Constants: bounds, by hand.

constexpr uint32_t kVersionOfNetwork = 2;

// Bounds of a mode's correlation time.
constexpr double kShortest_s = 0.02, kLongest_s = 1000.0;

/// Sums for first and second moments over all frames and their mirror images. Central moments are
/// computed later, so motions need not be held in memory.
struct MomentSums {
  double weight = 0.0, lagged_weight = 0.0;
  uint64_t frames = 0;
  BoneVector first = BoneVector::Zero();          // sum of b(t)
  BoneMatrix second = BoneMatrix::Zero();         // sum of b(t) b(t)'
  BoneVector lagged_first = BoneVector::Zero();   // sum of (b(t) + b(t + lag)) / 2
  BoneMatrix lagged_second = BoneMatrix::Zero();  // sum of the symmetric part of b(t) b(t + lag)'
};

void Add(const std::vector<BoneVector>& run, size_t lag, double weight, MomentSums& sums) {
  if (run.empty()) return;
  const auto n = static_cast<Eigen::Index>(run.size()), ahead = static_cast<Eigen::Index>(lag);
  Eigen::MatrixXd b(kBoneDims, n);
  for (Eigen::Index i = 0; i < n; ++i) b.col(i) = run[static_cast<size_t>(i)];
  sums.frames += run.size();
  sums.weight += weight * static_cast<double>(n);
  sums.first += weight * b.rowwise().sum();
  sums.second += weight * (b * b.transpose());
  if (n <= ahead) return;
  const auto now = b.leftCols(n - ahead), later = b.rightCols(n - ahead);
  const BoneMatrix product = now * later.transpose();
  sums.lagged_weight += weight * static_cast<double>(n - ahead);
  sums.lagged_first += 0.5 * weight * (now.rowwise().sum() + later.rowwise().sum());
  sums.lagged_second += 0.5 * weight * (product + product.transpose());
}

/// The reflection: negates x and exchanges left and right bones.
BoneMatrix Mirror() {
  BoneMatrix mirror = BoneMatrix::Zero();
  for (size_t i = 1; i < kJointCount; ++i) {
    const Eigen::Index from = FirstCoordinate(i - 1), to = FirstCoordinate(kMirroredJoint[i] - 1);
    for (int axis = 0; axis < 3; ++axis) {
      mirror(from + axis, to + axis) = axis == 0 ? -1.0 : 1.0;
    }
  }
  return mirror;
}

void CheckEnough(const MomentSums& sums, double lag_s) {
  constexpr uint64_t kFewest = 100;  // minimum sample for mean and variance
  if (sums.frames < kFewest) {
    throw InputError(
        fmt::format("posture prior: expected motions of at least {} finite postures, found {}",
                    kFewest, sums.frames));
  }
  if (!(sums.lagged_weight > 0.0)) {
    throw InputError(fmt::format(
        "posture prior: expected a motion that is longer than {:.2f} s, found none", lag_s));
  }
}

/// Central moments of all bones, symmetric in left and right.
struct Moments {
  BoneVector mean = BoneVector::Zero();
  BoneMatrix covariance = BoneMatrix::Zero(), lagged = BoneMatrix::Zero();
};

Moments ComputeMoments(const MomentSums& sums) {
  const BoneMatrix mirror = Mirror();
  const auto both_sides = [&](const BoneMatrix& m) -> BoneMatrix {
    return 0.5 * (m + mirror * m * mirror.transpose());
  };
  Moments out;
  const BoneVector mean = sums.first / sums.weight;
  out.mean = 0.5 * (mean + mirror * mean);
  out.covariance = both_sides(sums.second) / sums.weight - out.mean * out.mean.transpose();
  const BoneVector halfway = sums.lagged_first / sums.lagged_weight;
  const BoneVector lagged_mean = 0.5 * (halfway + mirror * halfway);
  out.lagged = both_sides(sums.lagged_second) / sums.lagged_weight -
               lagged_mean * out.mean.transpose() - out.mean * lagged_mean.transpose() +
               out.mean * out.mean.transpose();
  return out;
}

/// Eigenvectors in descending order of eigenvalue, each with its largest entry positive, so that
/// the result is deterministic.
template <typename Matrix>
std::pair<Eigen::VectorXd, Eigen::MatrixXd> SortedEigen(const Matrix& symmetric) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(symmetric);
  Eigen::VectorXd values = solver.eigenvalues().reverse();
  Eigen::MatrixXd vectors = solver.eigenvectors().rowwise().reverse();
  for (Eigen::Index k = 0; k < vectors.cols(); ++k) {
    Eigen::Index largest = 0;
    vectors.col(k).cwiseAbs().maxCoeff(&largest);
    if (vectors(largest, k) < 0.0) vectors.col(k) *= -1.0;
  }
  return {values, vectors};
}

}  // namespace

void PosturePriorOptions::Check() const {
  if (modes < 1 || modes > kBoneDims) {
    throw std::invalid_argument(
        fmt::format("PosturePriorOptions.modes = {}, must be in [1, {}]", modes, kBoneDims));
  }
  if (!(lag_s > 0.0 && lag_s <= 10.0)) {
    throw std::invalid_argument(
        fmt::format("PosturePriorOptions.lag_s = {}, must be in (0, 10]", lag_s));
  }
  if (!(slowness > 0.0 && slowness <= 100.0)) {
    throw std::invalid_argument(
        fmt::format("PosturePriorOptions.slowness = {}, must be in (0, 100]", slowness));
  }
}

std::vector<std::vector<BoneVector>> NormalisedRuns(const PriorClip& clip) {
  std::vector<std::vector<BoneVector>> runs(1);
  JointWeights all;
  all.fill(1.0);
  double yaw_rad = std::numbers::pi;
  for (const Posture& posture : clip.postures) {
    const bool finite = std::all_of(posture.position_m.begin(), posture.position_m.end(),
                                    [](const Eigen::Vector3d& p) { return p.allFinite(); });
    if (!finite) {
      if (!runs.back().empty()) runs.emplace_back();
      continue;
    }
    const Placement placement = EstimatePlacement(posture, all, yaw_rad);
    yaw_rad = placement.yaw_rad;
    const Posture own = Normalised(posture, placement);
    runs.back().push_back(ToBoneVector(Retargeted(own, StandardBoneLengths())));
  }
  return runs;
}

BoneVector ToBoneVector(const Posture& posture) {
  BoneVector bones_m;
  for (size_t i = 1; i < kJointCount; ++i) {
    bones_m.segment<3>(FirstCoordinate(i - 1)) =
        posture.position_m[i] - posture.position_m[ParentOf(i)];
  }
  return bones_m;
}

Posture PostureFromBones(const BoneVector& bones_m) {
  Posture posture;
  for (size_t i = 1; i < kJointCount; ++i) {
    posture.position_m[i] =
        posture.position_m[ParentOf(i)] + bones_m.segment<3>(FirstCoordinate(i - 1));
  }
  return posture;
}

PosturePrior PosturePrior::Learn(const std::vector<PriorClip>& clips,
                                 const PosturePriorOptions& options) {
  options.Check();
  MomentSums sums;
  for (const PriorClip& clip : clips) {
    const auto lag = static_cast<size_t>(std::max(1.0, std::round(options.lag_s / clip.frame_s)));
    for (const auto& run : NormalisedRuns(clip)) Add(run, lag, clip.weight, sums);
  }
  CheckEnough(sums, options.lag_s);
  const Moments moments = ComputeMoments(sums);
  PosturePrior out;
  out.frames = sums.frames;
  out.mean_m = moments.mean;
  const auto [variance, axes] = SortedEigen(moments.covariance);
  // Directions with less motion (0.1 mm) are not modes: their correlation would be rounding.
  constexpr double kLeast_m2 = 1e-8;
  Eigen::Index modes = 0;
  while (modes < options.modes && variance[modes] > kLeast_m2) ++modes;
  if (modes == 0) throw InputError("posture prior: expected motions, found nothing that moves");
  const Eigen::VectorXd spread = variance.head(modes).cwiseSqrt();
  const Eigen::MatrixXd white =
      spread.cwiseInverse().asDiagonal() * axes.leftCols(modes).transpose();
  const auto [correlation, turn] = SortedEigen(white * moments.lagged * white.transpose());
  out.modes_m = axes.leftCols(modes) * spread.asDiagonal() * turn;
  out.residual_m2 =
      (moments.covariance.diagonal() - out.modes_m.rowwise().squaredNorm()).cwiseMax(0.0);
  // correlation = exp(-lag / time)
  out.correlation_time_s.resize(modes);
  for (Eigen::Index k = 0; k < modes; ++k) {
    const double kept = std::clamp(correlation[k], 0.02, 0.9999);
    out.correlation_time_s[k] =
        std::clamp(-options.slowness * options.lag_s / std::log(kept), kShortest_s, kLongest_s);
  }
  return out;
}

void PosturePrior::Save(const std::filesystem::path& path) const {
  PayloadWriter out;
  out.Put(frames);
  const auto put = [&](const Eigen::MatrixXd& m) {
    const Eigen::MatrixXf single = m.cast<float>();
    out.PutArray(std::span<const float>(single.data(), static_cast<size_t>(single.size())));
  };
  for (const Eigen::MatrixXd& m : {Eigen::MatrixXd(mean_m), Eigen::MatrixXd(residual_m2),
                                   Eigen::MatrixXd(correlation_time_s), modes_m}) {
    put(m);
  }
  ContainerFormat format = kPriorFormat;
  if (network.empty()) {
    format.version = kVersionOfNetwork - 1;  // so that older programs can read it
  } else {
    out.Put(static_cast<uint32_t>(network.layers.front().bias.size()));
    PutPerceptron(out, network);
  }
  WriteContainer(path, format, out.bytes());
}

bool PosturePrior::IsFile(const std::filesystem::path& path) {
  return IsContainer(path, kPriorFormat);
}

namespace {

/// `count` numbers, each in [least, most], as a column.
Eigen::MatrixXd GetColumn(PayloadReader& in, std::string_view field, size_t count, double least,
                          double most) {
  const auto values = in.GetVector<float>(field);
  if (values.size() != count) in.Fail(field, fmt::format("expected {} numbers", count));
  for (const float v : values) {
    if (!(v >= least && v <= most)) {
      in.Fail(field, fmt::format("expected numbers in [{}, {}]", least, most));
    }
  }
  return Eigen::Map<const Eigen::VectorXf>(values.data(), static_cast<Eigen::Index>(count))
      .cast<double>();
}

/// Correlation time of each mode, seconds.
Eigen::VectorXd GetCorrelationTimes(PayloadReader& in) {
  const auto times_s = in.GetVector<float>("correlation times");
  if (times_s.empty() || times_s.size() > kBoneDims) {
    in.Fail("correlation times", fmt::format("expected 1 to {} modes", kBoneDims));
  }
  for (const float time_s : times_s) {
    if (!(time_s > 0.5 * kShortest_s && time_s < 2.0 * kLongest_s)) {
      in.Fail("correlation times", "expected 0.01 s to 2000 s");
    }
  }
  return Eigen::Map<const Eigen::VectorXf>(times_s.data(),
                                           static_cast<Eigen::Index>(times_s.size()))
      .cast<double>();
}

}  // namespace

PosturePrior PosturePrior::Load(const std::filesystem::path& path) {
  const ContainerFormat format = ReadContainerFormat(path, kPriorFormat, 1);
  return NamingTheFile(
      path, [&] { return FromBytes(ReadContainer(path, format), path.string(), format.version); });
}

PosturePrior PosturePrior::FromBytes(std::span<const std::byte> bytes, const std::string& name,
                                     uint32_t version) {
  PayloadReader in(bytes, name);
  PosturePrior out;
  out.frames = in.Get<uint64_t>("frames");
  constexpr double kLongestBone_m = 10.0;
  out.mean_m = GetColumn(in, "mean", kBoneDims, -kLongestBone_m, kLongestBone_m);
  out.residual_m2 = GetColumn(in, "rest", kBoneDims, 0.0, kLongestBone_m);
  out.correlation_time_s = GetCorrelationTimes(in);
  const auto modes = static_cast<size_t>(out.correlation_time_s.size());
  out.modes_m = GetColumn(in, "modes", kBoneDims * modes, -kLongestBone_m, kLongestBone_m);
  out.modes_m.resize(kBoneDims, out.correlation_time_s.size());
  if (version >= kVersionOfNetwork) {
    const Eigen::Index units = GetUnits(in);
    out.network = {GetPerceptron(in, {kPriorInputs, units, kBoneDims})};
  }
  in.ExpectEnd();
  return out;
}

}  // namespace ossa::recon
