#pragma once
#include <memory>
#include <optional>

#include "recon/methods/prepared_posture_internal.h"
#include "recon/models/prior_filter.h"

namespace ossa::recon {

/// What counts as seen. Constants: weights in [0, 1], by hand.
struct PriorCompletionOptions {
  double guess = 0.5;           // weight: what is trusted no more is a guess of the sensor's
  double least_trust = 0.02;    // weight: what is trusted no more is as good as not seen (a metre)
  double guessed_root_m = 0.3;  // standard deviation of the root's place where no hip is seen:
                                // anthropometry, about half a trunk, from the joints that are
};

/// Completes the postures of one person by a PosturePrior, for as long as something is in doubt.
class PriorCompletion {
 public:
  explicit PriorCompletion(std::shared_ptr<const PosturePrior> prior) : filter_(std::move(prior)) {}

  /// What is to be expected of the whole posture, camera space, bones of the lengths given. Joints
  /// count as far as they are trusted, in [0, 1]. `before`: the posture made of the frame before;
  /// what it was is known well when doubt begins.
  Posture Step(const PreparedPosture& prepared, const JointWeights& trust,
               const std::optional<Posture>& before, const BoneLengths& lengths_m);
  /// All joints are seen well, or the person is somebody else: what was expected counts no more.
  void Forget() { doubting_ = false; }

 private:
  PriorCompletionOptions options_;
  PriorFilter filter_;
  bool doubting_ = false;
};

}  // namespace ossa::recon
