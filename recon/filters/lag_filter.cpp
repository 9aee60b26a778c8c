#include "recon/filters/lag_filter_internal.h"

#include <algorithm>
#include <cmath>

namespace ossa::recon {
Eigen::Vector3d LagFilter::Step(const Eigen::Vector3d& value_m, double dt_s, double trust) {
  Measure(value_m, dt_s, trust);
  const Eigen::Vector3d euro_last = one_euro_value_;
  // One-Euro has no measurement weights: a measurement is blended with the last estimate by its
  // trust.
  const Eigen::Vector3d entering =
      steps_ == 0 ? value_m
                  : Eigen::Vector3d(euro_last + std::min(1.0, trust) * (value_m - euro_last));
  one_euro_value_ = one_euro_.Step(entering, dt_s);
  StepKalman(value_m, dt_s, trust);
  const double range_m = options_.jumpy_sensor_m - options_.smooth_sensor_m;
  const double jumpy = std::clamp((jitter_m_ - options_.smooth_sensor_m) / range_m, 0.0, 1.0);
  if (steps_++ == 0) {
    before_ = value_m;
    return value_m;
  }
  const double moved = (value_m - euro_last).norm();
  const double left =
      moved > 1e-9 ? std::clamp((value_m - one_euro_value_).norm() / moved, 0.0, 1.0) : 0.0;
  const Eigen::Vector3d euro_before =
      euro_last + options_.one_euro_back * left * (one_euro_value_ - euro_last);
  before_ = (1.0 - jumpy) * kalman_before_ + jumpy * euro_before;
  return (1.0 - jumpy) * position_ + jumpy * one_euro_value_;
}

void LagFilter::Measure(const Eigen::Vector3d& value_m, double dt_s, double trust) {
  if (steps_ >= 2 && trust > 0.5) {
    const double jump_m =
        std::min((value_m - 2.0 * last_ + before_last_).norm(), options_.most_jitter_m);
    jitter_m_ += (1.0 - std::exp(-dt_s / options_.jitter_memory_s)) * (jump_m - jitter_m_);
  }
  before_last_ = last_;
  last_ = value_m;
}

void LagFilter::StepKalman(const Eigen::Vector3d& value_m, double dt_s, double trust) {
  const double r = options_.noise_m * options_.noise_m / trust;
  if (steps_ == 0) {
    position_ = value_m;
    velocity_.setZero();
    p00_ = r, p01_ = 0.0, p11_ = options_.first_variance;
    return;
  }
  // x' = F x with F = [1, dt phi; 0, phi]: the velocity decays.
  const double phi = std::exp(-dt_s / options_.velocity_memory_s), f = dt_s * phi;
  const double q = options_.acceleration * options_.acceleration, t2 = dt_s * dt_s;
  const Eigen::Vector3d predicted = position_ + f * velocity_, faded = phi * velocity_;
  const double n00 = p00_ + 2.0 * f * p01_ + f * f * p11_ + q * t2 * t2 / 4.0;
  const double n01 = phi * (p01_ + f * p11_) + q * t2 * dt_s / 2.0;
  const double n11 = phi * phi * p11_ + q * t2;
  const Eigen::Vector3d innovation = value_m - predicted;
  const double k0 = n00 / (n00 + r), k1 = n01 / (n00 + r);
  const Eigen::Vector3d position = predicted + k0 * innovation, velocity = faded + k1 * innovation;
  // The smoother's gain, first row of P F' N^-1.
  const double a0 = p00_ + f * p01_, a1 = phi * p01_, det = n00 * n11 - n01 * n01;
  const double c0 = (a0 * n11 - a1 * n01) / det, c1 = (a1 * n00 - a0 * n01) / det;
  kalman_before_ = position_ + c0 * (position - predicted) + c1 * (velocity - faded);
  position_ = position;
  velocity_ = velocity;
  p00_ = (1.0 - k0) * n00;
  p01_ = (1.0 - k0) * n01;
  p11_ = n11 - k1 * n01;
}

}  // namespace ossa::recon
