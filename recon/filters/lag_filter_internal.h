#pragma once
#include <Eigen/Core>

#include "recon/filters/joint_filters.h"

// Constants: chosen on UI-PRMD by `ossa experiment sdk`, which with data = ["nested"] chooses the
// first two anew, each on people other than those it is tested on. Within a factor of two of these
// nothing moves by more than 2 %.

namespace ossa::recon {

/// Settings of LagFilter.
struct LagFilterOptions {
  double noise_m = 0.02;           // of one measurement, standard deviation, > 0
  double acceleration = 10.0;      // of a joint, m/s^2, standard deviation, > 0
  double velocity_memory_s = 0.3;  // a velocity fades with this time constant, > 0
  double first_variance = 0.3;     // of the velocity, m^2/s^2, before anything is known
  // Second differences of real moves stay below a centimetre a frame squared; sensors without any
  // smoothing of their own have five and more. Between these two filters are mixed.
  double smooth_sensor_m = 0.015, jumpy_sensor_m = 0.04;
  double most_jitter_m = 0.2;    // one gross error says little about the usual jitter
  double jitter_memory_s = 1.0;  // of the mean jitter
  double one_euro_back = 0.3;    // share of its next step that One-Euro's last estimate follows
};

/// The filter of `best`: one joint, now without lag and once more a frame later, when the next
/// measurement has told which way the joint went.
///
/// Two filters run beside each other, because sensors are of two kinds. One that jitters by
/// millimetres is followed by a Kalman filter whose velocity comes to rest by itself; its second
/// estimate is the fixed-interval smoother's (Rauch, Tung and Striebel 1965) over one frame. One
/// that jitters by centimetres has no velocity to speak of, and One-Euro serves it better. The
/// measured jitter, of this joint over the last second, says which of the two is taken.
class LagFilter {
 public:
  explicit LagFilter(const LagFilterOptions& options = {}) : options_(options) {}
  /// trust in (0, 1] divides the measurement's variance. The estimate for now.
  Eigen::Vector3d Step(const Eigen::Vector3d& value_m, double dt_s, double trust);
  /// What is now thought of the step before.
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
  double jitter_m_ = 0.0;  // mean second difference of what is measured
};

}  // namespace ossa::recon
