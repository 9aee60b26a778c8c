#pragma once
#include <Eigen/Core>
#include <memory>
#include <optional>

#include "recon/models/posture_prior.h"

namespace ossa::recon {

/// What is seen of one person at one time, normalised, of the person's own size.
struct PriorObservation {
  Posture seen;             // joints from where the root is taken to be
  JointWeights sd_m{};      // of each joint but the root, metres; 0: not seen
  double root_sd_m = 0;     // of where the root is taken to be
  bool guesses = false;     // some of it is a sensor's guess at what it does not see
  BoneLengths lengths_m{};  // of the person, > 0
};

/// Standard deviation of a joint that is fully trusted, metres; of one trusted by half it is twice
/// that. A person of whom the sensor only guesses a share of the joints is seen badly as a whole.
double BaseSigma_m(double share_of_guesses);

/// The posture that is to be expected of what was seen up to now (Kalman filter of a PosturePrior,
/// exact for it). What is hidden moves with what is seen, as far as it usually does; what is not
/// seen for long becomes what is usual. State: the modes, then the error of the root's place.
/// The prior's network corrects what it says, unless a sensor guesses: its guesses are wrong
/// together, and the network learned of joints that are seen or are not.
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
  /// The bones that the modes of the last step say, before the prior's network corrects them;
  /// normalised, the standard body.
  BoneVector Bones_m() const;
  /// What the prior's network reads, or would read, of the last step.
  PriorInput Input() const;

 private:
  void Predict(double dt_s, double root_sd_m);
  double NetworkShare(double dt_s);

  std::shared_ptr<const PosturePrior> prior_;
  PriorObservation last_;
  std::optional<double> network_share_;  // of the network's correction that is made
  Eigen::VectorXd mean_;
  Eigen::MatrixXd covariance_;
};

}  // namespace ossa::recon
