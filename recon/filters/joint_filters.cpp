#include "recon/filters/joint_filters.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace ossa::recon {
namespace {

/// Weight of a new value in a first-order low pass.
double LowPassShare(double cutoff_hz, double dt_s) {
  const double tau_s = 1.0 / (2.0 * std::numbers::pi * cutoff_hz);
  return 1.0 / (1.0 + tau_s / dt_s);
}

}  // namespace

Eigen::Vector3d HoltFilter::Step(const Eigen::Vector3d& value_m) {
  const HoltOptions& o = options_;
  const Eigen::Vector3d before_m = level_m_;
  if (count_ == 0) {
    level_m_ = value_m;
    trend_m_.setZero();
  } else {
    if (count_ == 1 && o.averages_second) {
      level_m_ = 0.5 * (value_m + last_m_);
    } else {
      // Changes within the jitter radius are damped before filtering.
      const double share = std::min(1.0, (value_m - before_m).norm() / o.jitter_radius_m);
      const Eigen::Vector3d damped_m = value_m * share + before_m * (1.0 - share);
      level_m_ = damped_m * (1.0 - o.smoothing) + (before_m + trend_m_) * o.smoothing;
    }
    trend_m_ = (level_m_ - before_m) * o.correction + trend_m_ * (1.0 - o.correction);
  }
  last_m_ = value_m;
  ++count_;
  const Eigen::Vector3d predicted_m = level_m_ + o.prediction * trend_m_;
  const double off_m = (predicted_m - value_m).norm();
  if (off_m <= o.max_deviation_radius_m) return predicted_m;
  return value_m + (predicted_m - value_m) * (o.max_deviation_radius_m / off_m);
}

Eigen::Vector3d OneEuroFilter::Step(const Eigen::Vector3d& value_m, double dt_s) {
  constexpr double kVelocityCutoff_hz = 1.0;  // of the paper
  if (!started_) {
    started_ = true;
    last_m_ = value_m_ = value_m;
    return value_m;
  }
  const Eigen::Vector3d& from_m = options_.speed_of_measurements ? last_m_ : value_m_;
  velocity_m_s_ +=
      LowPassShare(kVelocityCutoff_hz, dt_s) * ((value_m - from_m) / dt_s - velocity_m_s_);
  last_m_ = value_m;
  const double cutoff_hz = options_.min_cutoff_hz + options_.beta_per_m * velocity_m_s_.norm();
  value_m_ += LowPassShare(cutoff_hz, dt_s) * (value_m - value_m_);
  return value_m_;
}

Eigen::Vector3d VelocityKalman::Step(const Eigen::Vector3d& value_m, double dt_s, double trust) {
  constexpr double kRest_s = 0.2;  // initial velocity decays within a few frames; by hand
  constexpr double kFirstVariance_m2_s2 =
      1.0;  // initial standard deviation of velocity; anthropometry: people move at 1 m/s
  const double r = noise_m_ * noise_m_;
  if (!started_) {
    started_ = true;
    position_ = value_m;
    velocity_.setZero();
    covariance_ << r, 0.0, 0.0, kFirstVariance_m2_s2;
    return value_m;
  }
  position_ += dt_s * velocity_;
  Eigen::Matrix2d f;
  f << 1.0, dt_s, 0.0, 1.0;
  const double q = acceleration_ * acceleration_, t2 = dt_s * dt_s;
  Eigen::Matrix2d noise;
  noise << q * t2 * t2 / 4.0, q * t2 * dt_s / 2.0, q * t2 * dt_s / 2.0, q * t2;
  covariance_ = f * covariance_ * f.transpose() + noise;
  if (trust <= 0.0) {
    velocity_ *= std::exp(-dt_s / kRest_s);
    return position_;
  }
  const Eigen::Vector2d gain = covariance_.col(0) / (covariance_(0, 0) + r / trust);
  const Eigen::Vector3d innovation = value_m - position_;
  position_ += gain[0] * innovation;
  velocity_ += gain[1] * innovation;
  covariance_ -= gain * covariance_.row(0).eval();
  return position_;
}

}  // namespace ossa::recon
