#include <algorithm>
#include <cmath>

#include "recon/methods/adaptive_kalman_internal.h"

namespace ossa::recon {
namespace {

// Tuned on UI-PRMD by the trade of acceleration error against lag (tools/experiments): noise 2 cm
// covers what SDK joints jitter; 0.3 m/s^2 at rest, 2 m/s^2 more for every centimetre of lag.
constexpr double kNoise_m = 0.02;
constexpr double kRestAcceleration = 0.3;
constexpr double kAccelerationPerLag = 200.0;  // (m/s^2) / m
constexpr double kMostAcceleration = 30.0;
constexpr double kLagMemory_s = 0.15;

}  // namespace

Eigen::Vector3d AdaptiveKalman::Step(const Eigen::Vector3d& value_m, double dt_s, double trust) {
  const double r = kNoise_m * kNoise_m / trust;
  if (!started_) {
    started_ = true;
    position_ = value_m;
    velocity_.setZero();
    lag_.setZero();
    p00_ = r, p01_ = 0.0, p11_ = 0.3;
    return value_m;
  }
  const double q = std::pow(
      std::min(kRestAcceleration + kAccelerationPerLag * lag_.norm(), kMostAcceleration), 2.0);
  const double t2 = dt_s * dt_s;
  position_ += dt_s * velocity_;
  const double n00 = p00_ + 2.0 * dt_s * p01_ + t2 * p11_ + q * t2 * t2 / 4.0;
  const double n01 = p01_ + dt_s * p11_ + q * t2 * dt_s / 2.0;
  const double n11 = p11_ + q * t2;
  const Eigen::Vector3d innovation = value_m - position_;
  lag_ += trust * (1.0 - std::exp(-dt_s / kLagMemory_s)) * (innovation - lag_);
  const double k0 = n00 / (n00 + r), k1 = n01 / (n00 + r);
  position_ += k0 * innovation;
  velocity_ += k1 * innovation;
  p00_ = (1.0 - k0) * n00;
  p01_ = (1.0 - k0) * n01;
  p11_ = n11 - k1 * n01;
  return position_;
}

}  // namespace ossa::recon
