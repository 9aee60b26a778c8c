#pragma once
#include <Eigen/Core>

namespace ossa::recon {

/// Filters of one joint's position, metres and seconds. Each starts at its first value.

/// Double exponential smoothing as in the Kinect SDK's TransformSmoothParameters defaults
/// (smoothing 0.5, correction 0.5, prediction 0, jitter radius 5 cm, maximum deviation 4 cm).
class HoltFilter {
 public:
  Eigen::Vector3d Step(const Eigen::Vector3d& value);

 private:
  int count_ = 0;
  Eigen::Vector3d level_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d trend_ = Eigen::Vector3d::Zero();
};

/// Casiez, Roussel, Vogel, 1 Euro filter, CHI 2012.
class OneEuroFilter {
 public:
  explicit OneEuroFilter(double min_cutoff_hz = 1.5, double beta_per_m = 3.0)
      : min_cutoff_hz_(min_cutoff_hz), beta_per_m_(beta_per_m) {}
  Eigen::Vector3d Step(const Eigen::Vector3d& value, double dt_s);

 private:
  double min_cutoff_hz_, beta_per_m_;
  bool started_ = false;
  Eigen::Vector3d value_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d velocity_ = Eigen::Vector3d::Zero();
};

/// Kalman filter of constant velocity with white acceleration; the axes share one covariance.
class VelocityKalman {
 public:
  /// acceleration: standard deviation of the acceleration, m/s^2; noise of one measurement, metres.
  VelocityKalman(double acceleration = 6.0, double noise_m = 0.02)
      : acceleration_(acceleration), noise_m_(noise_m) {}
  /// trust in (0, 1] divides the measurement's variance; 0: prediction only.
  Eigen::Vector3d Step(const Eigen::Vector3d& value, double dt_s, double trust);

 private:
  double acceleration_, noise_m_;
  bool started_ = false;
  Eigen::Vector3d position_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d velocity_ = Eigen::Vector3d::Zero();
  Eigen::Matrix2d covariance_ = Eigen::Matrix2d::Identity();
};

}  // namespace ossa::recon
