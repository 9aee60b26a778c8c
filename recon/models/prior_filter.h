#pragma once
#include <Eigen/Core>
#include <memory>
#include <optional>

#include "recon/models/posture_prior.h"

namespace ossa::recon {

/// An observation of one person, normalised, at the person's own size.
struct PriorObservation {
  Posture seen;             // joints relative to the assumed root
  JointWeights sd_m{};      // standard deviation of each joint except the root, metres; 0: not seen
  double root_sd_m = 0;     // standard deviation of the assumed root
  bool guesses = false;     // includes a sensor's guesses of unseen joints
  BoneLengths lengths_m{};  // the person's, > 0
};

/// Standard deviation of a fully trusted joint, metres; at half trust it is twice that. It grows
/// with the share of joints that the sensor only guesses.
double BaseSigma_m(double share_of_guesses);

/// The expected posture given all observations so far: the Kalman filter of a PosturePrior, for
/// which it is exact. Hidden joints move with visible ones as far as they are correlated; joints
/// not seen for long approach the mean. State: the modes, then the root's position error. The
/// prior's network corrects the result, unless a sensor guesses: errors of guesses are correlated,
/// and the network was trained on joints that are either seen or not.
class PriorFilter {
 public:
  explicit PriorFilter(std::shared_ptr<const PosturePrior> prior);
  /// Resets to the prior.
  void Reset();
  /// Predicts `dt_s` (>= 0) ahead and updates. The result is normalised, with the given bone
  /// lengths and the root at its expected position.
  Posture Step(double dt_s, const PriorObservation& observation);
  /// Standard deviation of a joint relative to the root, all axes together, metres, at the standard
  /// size.
  double Uncertainty_m(Joint joint) const;
  /// The bones given by the modes of the last step, before the prior's network corrects them;
  /// normalised, at the standard size.
  BoneVector Bones_m() const;
  /// The input of the prior's network in the last step.
  PriorInput Input() const;

 private:
  void Predict(double dt_s, double root_sd_m);
  double NetworkShare(double dt_s);

  std::shared_ptr<const PosturePrior> prior_;
  PriorObservation last_;
  std::optional<double> network_share_;  // applied share of the network's correction
  Eigen::VectorXd mean_;
  Eigen::MatrixXd covariance_;
};

}  // namespace ossa::recon
