#pragma once
#include <Eigen/Core>
#include <memory>

#include "recon/gp/posture_prior.h"

namespace ossa::recon {

/// What is seen of one person at one time, normalised, of the person's own size.
struct PriorObservation {
  Posture seen;             // joints from where the root is taken to be
  JointWeights sd_m{};      // of each joint but the root, metres; 0: not seen
  double root_sd_m = 0;     // of where the root is taken to be
  BoneLengths lengths_m{};  // of the person, > 0
};

/// The posture that is to be expected of what was seen up to now (Kalman filter of a PosturePrior,
/// exact for it). What is hidden moves with what is seen, as far as it usually does; what is not
/// seen for long becomes what is usual. State: the modes, then the error of the root's place.
class PriorFilter {
 public:
  explicit PriorFilter(std::shared_ptr<const PosturePrior> prior);
  /// Nothing is known but the prior.
  void Reset();
  /// `dt_s` (>= 0) later, seeing that: normalised, bones of the lengths given, the root where it is
  /// expected to be.
  Posture Step(double dt_s, const PriorObservation& observation);
  /// Standard deviation of a joint's place relative to the root, all axes together, metres, on the
  /// standard body.
  double Uncertainty_m(Joint joint) const;

 private:
  void Predict(double dt_s, double root_sd_m);

  std::shared_ptr<const PosturePrior> prior_;
  Eigen::VectorXd mean_;
  Eigen::MatrixXd covariance_;
};

}  // namespace ossa::recon
