#pragma once
#include <Eigen/Core>

namespace ossa::recon {

/// Kalman filter of constant velocity whose process noise follows the motion: the low-passed
/// innovation is near zero while the filter keeps up, whatever the measurement noise, and grows
/// when it lags. Still joints are smoothed hard, moving ones followed within a frame.
class AdaptiveKalman {
 public:
  /// trust in (0, 1] divides the measurement's variance.
  Eigen::Vector3d Step(const Eigen::Vector3d& value_m, double dt_s, double trust);

 private:
  bool started_ = false;
  Eigen::Vector3d position_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d velocity_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d lag_ = Eigen::Vector3d::Zero();  // low-passed innovation, metres
  double p00_ = 0.0, p01_ = 0.0, p11_ = 0.0;       // covariance of position and velocity
};

}  // namespace ossa::recon
