#include "recon/models/linear_filter.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace ossa::recon {
namespace {

// Scales of a good sensor's jitter and of a bad one's gross errors. On ITOP's estimates 3, 10 and
// 30 cm, or 4 to 32 cm, are no better on the held-out half.
constexpr std::array<double, 2> kReaches_m = {0.05, 0.15};
constexpr Eigen::Index kWays = 1 + Eigen::Index{kReaches_m.size()};

/// The joint, its parent, its children.
const std::vector<size_t>& Neighbourhood(size_t joint) {
  static const auto kAll = [] {
    JointArray<std::vector<size_t>> all;
    for (size_t i = 0; i < kJointCount; ++i) {
      all[i].push_back(i);
      if (i > 0) all[i].push_back(ParentOf(i));
      for (size_t k = i + 1; k < kJointCount; ++k) {
        if (kJointParent[k] == static_cast<int>(i)) all[i].push_back(k);
      }
    }
    return all;
  }();
  return kAll[joint];
}

}  // namespace

size_t LearnedSideOf(size_t joint) { return std::min(joint, kMirroredJoint[joint]); }

Eigen::Index FilterFeatureSize(size_t joint) {
  return 3 * LinearFilter::kSteps * static_cast<Eigen::Index>(Neighbourhood(joint).size());
}

Eigen::VectorXf FilterFeature(std::span<const Posture> window, const LinearFilter::Steps& steps,
                              double yaw_rad, size_t joint, bool mirrored) {
  const auto own = [&](size_t i) { return mirrored ? kMirroredJoint[i] : i; };
  const double c = std::cos(yaw_rad), s = std::sin(yaw_rad), side = mirrored ? -1.0 : 1.0;
  const size_t newest = window.size() - 1;
  Eigen::VectorXf feature(FilterFeatureSize(joint));
  Eigen::Index at = 0;
  for (const size_t neighbour : Neighbourhood(own(joint))) {
    const size_t i = steps[own(neighbour)] >= LinearFilter::kFewest ? own(neighbour) : joint;
    const auto position = [&](size_t ago) { return window[newest - ago].position_m[i]; };
    const auto known = static_cast<size_t>(std::min(steps[i], LinearFilter::kSteps));
    const Eigen::Vector3d mean = (position(0) - position(known)) / static_cast<double>(known);
    for (size_t ago = LinearFilter::kSteps; ago-- > 0; at += 3) {
      const Eigen::Vector3d step = ago < known ? position(ago) - position(ago + 1) : mean;
      feature[at] = static_cast<float>(side * (c * step.x() - s * step.z()));
      feature[at + 1] = static_cast<float>(step.y());
      feature[at + 2] = static_cast<float>(s * step.x() + c * step.z());
    }
  }
  return feature;
}

Eigen::Index InfluenceFeatureSize(LinearFilter::Output output) {
  return kWays * (LinearFilter::kInfluencing + output);
}

Eigen::Matrix3Xf InfluenceFeature(std::span<const Posture> window, int steps, size_t joint,
                                  LinearFilter::Output output) {
  const auto seen = [&](int ago) -> const Eigen::Vector3d& {
    return window[window.size() - 1 - static_cast<size_t>(ago)].position_m[joint];
  };
  const Eigen::Vector3d& from = seen(output);
  Eigen::Matrix3Xf feature(3, InfluenceFeatureSize(output));
  Eigen::Index at = 0;
  for (int ago = 0; ago <= output + LinearFilter::kInfluencing; ++ago) {
    if (ago == output) continue;
    const Eigen::Vector3d way = seen(std::min(ago, steps)) - from;
    feature.col(at++) = way.cast<float>();
    for (const double reach_m : kReaches_m) {
      feature.col(at++) = (way / (1.0 + way.squaredNorm() / (reach_m * reach_m))).cast<float>();
    }
  }
  return feature;
}

bool LinearFilter::Influences(Output output, size_t joint) const {
  return WeightsOf(output, joint).cols() == 1;
}

bool LinearFilter::HasInfluences() const {
  for (const Output output : {kNow, kBefore}) {
    for (size_t joint = 0; joint < kJointCount; ++joint) {
      if (Influences(output, joint)) return true;
    }
  }
  return false;
}

const Eigen::MatrixXf& LinearFilter::WeightsOf(Output output, size_t joint) const {
  return weights[output][LearnedSideOf(joint)];
}

std::array<Eigen::Vector3d, LinearFilter::kOutputs> LinearFilter::Estimate(
    size_t joint, std::span<const Posture> window, const Steps& steps, double yaw_rad) const {
  const bool mirrored = LearnedSideOf(joint) != joint;
  const double c = std::cos(yaw_rad), s = std::sin(yaw_rad);
  std::array<Eigen::Vector3d, kOutputs> estimates;
  Eigen::VectorXf feature;  // features of both outputs
  for (const Output output : {kNow, kBefore}) {
    const Eigen::MatrixXf& known = WeightsOf(output, joint);
    Eigen::Vector3d& estimate = estimates[output];
    estimate = window[window.size() - 1 - output].position_m[joint];
    if (known.size() == 0) continue;
    if (known.cols() == 1) {
      const auto seen = static_cast<int>(window.size()) - 1;
      estimate += (InfluenceFeature(window, seen, joint, output) * known).cast<double>();
      continue;
    }
    if (steps[joint] < kFewest) continue;
    if (feature.size() == 0) feature = FilterFeature(window, steps, yaw_rad, joint, mirrored);
    Eigen::Vector3d off = (known.transpose() * feature).cast<double>();
    if (mirrored) off.x() = -off.x();
    estimate += Eigen::Vector3d(c * off.x() + s * off.z(), off.y(), -s * off.x() + c * off.z());
  }
  return estimates;
}

}  // namespace ossa::recon
