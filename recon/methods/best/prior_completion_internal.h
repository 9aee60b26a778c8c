#pragma once
#include <memory>
#include <optional>

#include "recon/methods/prepared_posture_internal.h"
#include "recon/models/prior_filter.h"

namespace ossa::recon {

/// Thresholds of trust. Constants: weights in [0, 1], by hand.
struct PriorCompletionOptions {
  double guess = 0.5;         // weight up to which a joint is a guess of the sensor
  double least_trust = 0.02;  // weight up to which a joint counts as unseen
  /// Standard deviation of the root if no hip is seen: anthropometry, about half a trunk.
  double guessed_root_m = 0.3;
};

/// Completes a person's postures by a PosturePrior while any joint is in doubt.
class PriorCompletion {
 public:
  explicit PriorCompletion(std::shared_ptr<const PosturePrior> prior) : filter_(std::move(prior)) {}

  /// The expected posture, camera space, with the given bone lengths. Joints are weighted by
  /// `trust` in [0, 1]. `before`: the result of the previous frame, which is well known when doubt
  /// begins.
  Posture Step(const PreparedPosture& prepared, const JointWeights& trust,
               const std::optional<Posture>& before, const BoneLengths& lengths_m);
  /// Resets the filter: all joints are well observed, or the person is another.
  void Forget() { doubting_ = false; }

 private:
  PriorCompletionOptions options_;
  PriorFilter filter_;
  bool doubting_ = false;
};

}  // namespace ossa::recon
