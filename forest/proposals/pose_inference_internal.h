#pragma once
#include <Eigen/Core>
#include <array>
#include <optional>
#include <span>
#include <vector>

#include "forest/factor_model_internal.h"
#include "forest/forest.h"
#include "forest/proposals/modes_internal.h"

namespace ossa::forest {

using TargetModes = std::vector<std::vector<Mode>>;  // one list per target

/// The posterior marginal of one target, metres in camera space: its prediction by all other
/// targets, and its modes weighted by that.
struct TargetMarginal : Prediction {
  std::vector<double> weight;      // per mode: P(it is the target's | the other targets)
  std::vector<double> confidence;  // per mode: its own confidence
  double support() const;          // P(one of the modes is the target's)
};

/// Marginals of all targets of one object under the likeliest of the model's pose priors.
struct PoseMarginals {
  std::vector<TargetMarginal> target;
  double margin = 0.0;           // of that pose prior over the next best, nats
  double mean_confidence = 0.0;  // mean of the densest modes' own confidences
  double mean_support = 0.0;
  std::vector<double> neighbour_support;  // per target: of the targets most correlated with it
};

/// Infers which modes belong together, by expectation propagation: every target is predicted from
/// all others by the pose priors, its modes are weighted by that prediction, and so on.
/// Precondition: the model has pose priors.
PoseMarginals InferPose(const ForestModel& model, std::span<const float> context_posterior,
                        const TargetModes& modes);

/// A target's refined position, and the probability that it is within 10 cm.
struct RefinedPlace {
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();
  double confidence = 0.0;
};

/// A candidate position of a target, and the features of its confidence.
struct PlaceCandidate {
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();
  std::array<float, PlaceConfidence::kFeatures> feature{};
  bool is_fused = false;  // fused from modes and other targets; else a separate mode
  int mode = -1;          // dominant mode; -1: none
  std::optional<double> refined_confidence;  // of a fused position that was refined
};
/// `refined` may be null: the fused position is then unchanged.
std::vector<PlaceCandidate> Candidates(const ProposalTarget& target, const PoseMarginals& marginals,
                                       size_t target_index, const std::vector<Mode>& modes,
                                       const RefinedPlace* refined = nullptr);
/// P(within 10 cm of the target).
double ComputeConfidence(const ProposalTarget& target, const PlaceCandidate& candidate);

/// The fusion of the prediction and the likeliest mode, for this noise of modes.
Eigen::Vector3d Fuse(const TargetMarginal& marginal, const std::vector<Mode>& modes,
                     double mode_noise_m);

}  // namespace ossa::forest
