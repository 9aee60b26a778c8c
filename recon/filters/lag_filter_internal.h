#pragma once
#include <Eigen/Core>

#include "recon/filters/joint_filters_internal.h"

namespace ossa::recon {

/// The filter of `best`: one joint, now without lag and once more a frame later, when the next
/// measurement has told which way the joint went.
///
/// Two filters run beside each other, because sensors are of two kinds. One that jitters by
/// millimetres is followed by a Kalman filter whose velocity comes to rest by itself; its second
/// word is the fixed-interval smoother's (Rauch, Tung and Striebel 1965) over one frame. One that
/// jitters by centimetres has no velocity to speak of, and One-Euro serves it better. The measured
/// jitter, of this joint over the last second, says which of the two is heard.
class LagFilter {
 public:
  /// Standard deviations of one measurement, metres, and of a joint's acceleration, m/s^2.
  explicit LagFilter(double noise_m = 0.02, double acceleration = 10.0)
      : noise_m_(noise_m), acceleration_(acceleration) {}
  /// trust in (0, 1] divides the measurement's variance. The estimate for now.
  Eigen::Vector3d Step(const Eigen::Vector3d& value_m, double dt_s, double trust);
  /// What is now thought of the step before.
  const Eigen::Vector3d& before_m() const { return before_; }

 private:
  void StepKalman(const Eigen::Vector3d& value_m, double dt_s, double trust);
  void Measure(const Eigen::Vector3d& value_m, double dt_s, double trust);

  double noise_m_, acceleration_;
  int steps_ = 0;
  Eigen::Vector3d position_ = Eigen::Vector3d::Zero(), velocity_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d kalman_before_ = Eigen::Vector3d::Zero(), before_ = Eigen::Vector3d::Zero();
  double p00_ = 0.0, p01_ = 0.0, p11_ = 0.0;  // covariance of position and velocity
  OneEuroFilter one_euro_;
  Eigen::Vector3d one_euro_value_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d last_ = Eigen::Vector3d::Zero(), before_last_ = Eigen::Vector3d::Zero();
  double jitter_m_ = 0.0;  // mean second difference of what is measured
};

}  // namespace ossa::recon
