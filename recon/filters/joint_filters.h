#pragma once
#include <Eigen/Core>

namespace ossa::recon {

// Filters of one joint's position, in metres and seconds. Each starts at its first value.

/// The Kinect SDK's NUI_TRANSFORM_SMOOTH_PARAMETERS (Azimi, "Skeletal Joint Smoothing White Paper",
/// Microsoft 2012).
struct HoltOptions {
  // The defaults are the SDK's own.
  double smoothing = 0.5;                // weight, [0, 1): 0 = raw; 1 - alpha of the SDK's paper
  double correction = 0.5;               // weight, [0, 1]: trend gain gamma of the SDK's paper
  double prediction = 0.5;               // frames to predict into the future, >= 0; the SDK's
  double jitter_radius_m = 0.05;         // smaller moves are damped further, > 0; the SDK's
  double max_deviation_radius_m = 0.04;  // largest distance from the input, > 0; the SDK's
  /// Start with the mean of the first two values, as the white paper's code does.
  bool averages_second = true;

  /// The SDK's defaults: 0.5 0.5 0.5 0.05 0.04.
  static HoltOptions Default() { return {}; }
  /// The white paper's second and third recommendation: smoother, later.
  static HoltOptions Smooth() { return {0.5, 0.1, 0.5, 0.1, 0.1}; }
  static HoltOptions VerySmooth() { return {0.7, 0.3, 1.0, 1.0, 1.0}; }
  /// For the method holt: without prediction, so that the result is for the frame itself.
  static HoltOptions WithoutPrediction() { return {0.5, 0.5, 0.0, 0.05, 0.04, false}; }
};

/// Double exponential smoothing (C. C. Holt 1957) as the SDK does it: jitter damping, level, trend,
/// prediction, limit of the deviation.
class HoltFilter {
 public:
  HoltFilter() : HoltFilter(HoltOptions::WithoutPrediction()) {}
  explicit HoltFilter(const HoltOptions& options) : options_(options) {}
  Eigen::Vector3d Step(const Eigen::Vector3d& value_m);
  /// Keeps the filter's state.
  void SetOptions(const HoltOptions& options) { options_ = options; }

 private:
  HoltOptions options_;
  int count_ = 0;
  Eigen::Vector3d last_m_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d level_m_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d trend_m_ = Eigen::Vector3d::Zero();
};

/// The two parameters of the One-Euro filter, and the speed that it uses.
struct OneEuroOptions {
  double min_cutoff_hz =
      1.5;  // at rest, > 0; by hand, as in Casiez 2012: until a resting joint does not jitter
  double beta_per_m = 4.0;  // Hz more per m/s, >= 0; by hand, until a fast one does not lag
  /// True: speed between measurements. False: from the last estimate to the new measurement.
  bool speed_of_measurements = true;

  /// For `ossa track --smoothing one-euro`.
  static OneEuroOptions Default() { return {}; }
  /// For the methods one-euro and best.
  static OneEuroOptions ForMethods() { return {1.5, 3.0, false}; }
};

/// Casiez, Roussel, Vogel, 1 Euro filter, CHI 2012.
class OneEuroFilter {
 public:
  OneEuroFilter() : OneEuroFilter(OneEuroOptions::ForMethods()) {}
  explicit OneEuroFilter(const OneEuroOptions& options) : options_(options) {}
  /// `dt_s` > 0.
  Eigen::Vector3d Step(const Eigen::Vector3d& value_m, double dt_s);
  /// Keeps the filter's state.
  void SetOptions(const OneEuroOptions& options) { options_ = options; }

 private:
  OneEuroOptions options_;
  bool started_ = false;
  Eigen::Vector3d last_m_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d value_m_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d velocity_m_s_ = Eigen::Vector3d::Zero();
};

/// Kalman filter of constant velocity with white acceleration; the axes share one covariance.
class VelocityKalman {
 public:
  /// acceleration: standard deviation of the acceleration, m/s^2; noise of one measurement, metres.
  explicit VelocityKalman(double acceleration = 6.0, double noise_m = 0.02)
      : acceleration_(acceleration), noise_m_(noise_m) {}
  /// `trust` in (0, 1] divides the measurement's variance; 0: prediction only. `dt_s` > 0.
  Eigen::Vector3d Step(const Eigen::Vector3d& value_m, double dt_s, double trust);

 private:
  double acceleration_, noise_m_;
  bool started_ = false;
  Eigen::Vector3d position_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d velocity_ = Eigen::Vector3d::Zero();
  Eigen::Matrix2d covariance_ = Eigen::Matrix2d::Identity();
};

}  // namespace ossa::recon
