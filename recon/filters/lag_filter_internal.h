#pragma once
#include <Eigen/Core>

#include "recon/filters/joint_filters.h"

// Constants: chosen on UI-PRMD by `ossa experiment sdk`, which with data = ["nested"] chooses the
// first two in nested cross-validation over people. Varied by a factor of two, none changes the
// result by more than 2 %.

namespace ossa::recon {

/// Settings of LagFilter.
struct LagFilterOptions {
  double noise_m = 0.02;           // standard deviation of a measurement, > 0
  double acceleration = 10.0;      // standard deviation of a joint's acceleration, m/s^2, > 0
  double velocity_memory_s = 0.3;  // time constant of the velocity's decay, > 0
  double first_variance = 0.3;     // initial variance of the velocity, m^2/s^2
  // Second differences of real motion stay below a centimetre per frame squared; those of sensors
  // without smoothing reach five and more. Between these two limits both filters are mixed.
  double smooth_sensor_m = 0.015, jumpy_sensor_m = 0.04;
  double most_jitter_m = 0.2;  // cap of one sample: a gross error must not dominate the mean jitter
  double jitter_memory_s = 1.0;  // time constant of the mean jitter
  double one_euro_back = 0.3;    // share of the next step added to One-Euro's last estimate
};

/// The filter of `best` for one joint: an estimate without lag, and a revised one a frame later,
/// when the next measurement has shown the direction of motion.
///
/// Two filters run side by side, because there are two kinds of sensors. For a jitter of
/// millimetres there is a Kalman filter with decaying velocity; its revised estimate is that of the
/// fixed-interval smoother (Rauch, Tung and Striebel 1965) over one frame. With a jitter of
/// centimetres velocity cannot be estimated, and One-Euro is better. The jitter of this joint,
/// measured over the last second, selects between them.
class LagFilter {
 public:
  explicit LagFilter(const LagFilterOptions& options = {}) : options_(options) {}
  /// The estimate for now. The measurement's variance is divided by `trust` in (0, 1].
  Eigen::Vector3d Step(const Eigen::Vector3d& value_m, double dt_s, double trust);
  /// The revised estimate of the previous step.
  const Eigen::Vector3d& before_m() const { return before_; }

 private:
  void StepKalman(const Eigen::Vector3d& value_m, double dt_s, double trust);
  void Measure(const Eigen::Vector3d& value_m, double dt_s, double trust);

  LagFilterOptions options_;
  int steps_ = 0;
  Eigen::Vector3d position_ = Eigen::Vector3d::Zero(), velocity_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d kalman_before_ = Eigen::Vector3d::Zero(), before_ = Eigen::Vector3d::Zero();
  double p00_ = 0.0, p01_ = 0.0, p11_ = 0.0;  // covariance of position and velocity
  OneEuroFilter one_euro_;
  Eigen::Vector3d one_euro_value_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d last_ = Eigen::Vector3d::Zero(), before_last_ = Eigen::Vector3d::Zero();
  double jitter_m_ = 0.0;  // mean second difference of the measurements
};

}  // namespace ossa::recon
