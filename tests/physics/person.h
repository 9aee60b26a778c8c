#pragma once
#include <cmath>
#include <random>

#include "recon/posture.h"

namespace ossa::physics::test {

/// A standing person of 1.75 m with its feet on y = 0, facing +z, arms a little away from the body.
inline recon::Posture StandingPerson() {
  recon::Posture p;
  using recon::Joint;
  p[Joint::kHipCenter] = {0.0, 0.98, 0.0};
  p[Joint::kSpine] = {0.0, 1.06, 0.0};
  p[Joint::kShoulderCenter] = {0.0, 1.43, 0.0};
  p[Joint::kHead] = {0.0, 1.63, 0.02};
  for (const double side : {1.0, -1.0}) {
    const auto at = [&](size_t joint) -> Eigen::Vector3d& {
      return p.position_m[side > 0 ? joint : recon::kMirroredJoint[joint]];
    };
    at(4) = {0.18 * side, 1.40, 0.0};
    at(5) = {0.28 * side, 1.14, -0.02};
    at(6) = {0.33 * side, 0.91, 0.06};
    at(7) = {0.34 * side, 0.83, 0.10};
    at(12) = {0.09 * side, 0.91, 0.0};
    at(13) = {0.10 * side, 0.49, 0.02};
    at(14) = {0.10 * side, 0.08, -0.02};
    at(15) = {0.11 * side, 0.035, 0.11};
  }
  return p;
}

inline recon::Posture Moved(recon::Posture posture, const Eigen::Vector3d& by_m) {
  for (auto& p : posture.position_m) p += by_m;
  return posture;
}

/// y = 0.
inline Eigen::Vector4d Ground() { return {0.0, 1.0, 0.0, 0.0}; }

/// Swings arms and legs, sways and bends: smooth, seeded by nothing, bone lengths not quite kept.
inline recon::Posture DancingPerson(double time_s) {
  recon::Posture p = StandingPerson();
  using recon::Joint;
  const double a = 2.0 * M_PI * 0.5 * time_s;
  const Eigen::Vector3d sway(0.05 * std::sin(a), 0.0, 0.03 * std::cos(a));
  for (size_t i = 0; i < 14; ++i) p.position_m[i] += sway;
  p[Joint::kHandLeft] += Eigen::Vector3d(0.15, 0.5 + 0.2 * std::sin(2 * a), 0.2);
  p[Joint::kWristLeft] += Eigen::Vector3d(0.15, 0.42 + 0.2 * std::sin(2 * a), 0.18);
  p[Joint::kElbowLeft] += Eigen::Vector3d(0.1, 0.12 + 0.06 * std::sin(2 * a), 0.08);
  p[Joint::kHandRight] += Eigen::Vector3d(-0.1, 0.2, 0.25 * std::sin(1.5 * a));
  p[Joint::kWristRight] += Eigen::Vector3d(-0.1, 0.18, 0.2 * std::sin(1.5 * a));
  p[Joint::kElbowRight] += Eigen::Vector3d(-0.06, 0.06, 0.1 * std::sin(1.5 * a));
  return p;
}

constexpr double kFrame_s = 1.0 / 30.0;

/// Bone lengths of the standing person.
inline recon::BoneLengths Lengths() { return recon::MeasureBoneLengths(StandingPerson()); }

/// Largest relative error of a bone's length against the standing person's.
inline double LargestLengthError(const recon::Posture& posture) {
  const auto now = recon::MeasureBoneLengths(posture), wanted = Lengths();
  double largest = 0.0;
  for (size_t i = 1; i < recon::kJointCount; ++i) {
    largest = std::max(largest, std::abs(now[i] / wanted[i] - 1.0));
  }
  return largest;
}

/// White noise on every joint, with this standard deviation per axis.
inline recon::Posture Shaken(recon::Posture posture, double sigma_m, std::mt19937_64& random) {
  std::normal_distribution<double> normal(0.0, sigma_m);
  for (auto& p : posture.position_m) {
    for (double& v : p) v += normal(random);
  }
  return posture;
}

inline double LargestDistance(const recon::Posture& a, const recon::Posture& b) {
  double largest = 0.0;
  for (size_t i = 0; i < recon::kJointCount; ++i) {
    largest = std::max(largest, (a.position_m[i] - b.position_m[i]).norm());
  }
  return largest;
}

}  // namespace ossa::physics::test
