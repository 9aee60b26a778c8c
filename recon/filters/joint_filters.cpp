#include "recon/filters/joint_filters_internal.h"

#include <cmath>

namespace ossa::recon {

// Constants: of Holt's filter, the Kinect SDK's defaults; of One-Euro, Casiez 2012.

Eigen::Vector3d HoltFilter::Step(const Eigen::Vector3d& value) {
  constexpr double kSmoothing = 0.5, kCorrection = 0.5, kJitter_m = 0.05,
                   kDeviation_m = 0.04;  // shares
  if (count_ == 0) {
    level_ = value;
    trend_.setZero();
    ++count_;
    return value;
  }
  // Moves within the jitter radius are damped before they enter.
  Eigen::Vector3d damped = value;
  const double moved = (value - level_).norm();
  if (moved <= kJitter_m) {
    damped = value * (moved / kJitter_m) + level_ * (1.0 - moved / kJitter_m);
  }
  const Eigen::Vector3d before = level_;
  level_ = damped * (1.0 - kSmoothing) + (level_ + trend_) * kSmoothing;
  trend_ = (level_ - before) * kCorrection + trend_ * (1.0 - kCorrection);
  Eigen::Vector3d out = level_;
  const double deviation = (out - value).norm();
  if (deviation > kDeviation_m) out = value + (out - value) * (kDeviation_m / deviation);
  return out;
}

Eigen::Vector3d OneEuroFilter::Step(const Eigen::Vector3d& value, double dt_s) {
  const auto alpha = [dt_s](double cutoff_hz) {
    const double tau_s = 1.0 / (2.0 * M_PI * cutoff_hz);
    return 1.0 / (1.0 + tau_s / dt_s);
  };
  if (!started_) {
    started_ = true;
    value_ = value;
    velocity_.setZero();
    return value;
  }
  constexpr double kVelocityCutoff_hz = 1.0;
  const double a_velocity = alpha(kVelocityCutoff_hz);
  velocity_ += a_velocity * ((value - value_) / dt_s - velocity_);
  const double a = alpha(min_cutoff_hz_ + beta_per_m_ * velocity_.norm());
  value_ += a * (value - value_);
  return value_;
}

Eigen::Vector3d VelocityKalman::Step(const Eigen::Vector3d& value, double dt_s, double trust) {
  const double r = noise_m_ * noise_m_;
  if (!started_) {
    started_ = true;
    position_ = value;
    velocity_.setZero();
    covariance_ << r, 0.0, 0.0, 1.0;  // 1 m/s: people move
    return value;
  }
  position_ += dt_s * velocity_;
  Eigen::Matrix2d f;
  f << 1.0, dt_s, 0.0, 1.0;
  const double q = acceleration_ * acceleration_, t2 = dt_s * dt_s;
  Eigen::Matrix2d noise;
  noise << q * t2 * t2 / 4.0, q * t2 * dt_s / 2.0, q * t2 * dt_s / 2.0, q * t2;
  covariance_ = f * covariance_ * f.transpose() + noise;
  if (trust <= 0.0) {
    velocity_ *= std::exp(-dt_s / 0.2);  // nothing is known: come to rest within a few frames
    return position_;
  }
  const Eigen::Vector2d gain = covariance_.col(0) / (covariance_(0, 0) + r / trust);
  const Eigen::Vector3d innovation = value - position_;
  position_ += gain[0] * innovation;
  velocity_ += gain[1] * innovation;
  covariance_ -= gain * covariance_.row(0).eval();
  return position_;
}

}  // namespace ossa::recon
