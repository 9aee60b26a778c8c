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

using TargetModes = std::vector<std::vector<Mode>>;  // a list a target

/// The posterior marginal of one target, metres in camera space: its prediction by all other
/// targets, and its modes weighed by that.
struct TargetMarginal : Prediction {
  std::vector<double> weight;      // of each mode: P(it is the target's | the other targets)
  std::vector<double> confidence;  // of each mode by itself
  double support() const;          // P(one of the modes is the target's)
};

/// Marginals of all targets of one object under the likeliest of the model's pose priors.
struct PoseMarginals {
  std::vector<TargetMarginal> target;
  double margin = 0.0;           // of that pose prior against the next, nats
  double mean_confidence = 0.0;  // of the densest modes by themselves
  double mean_support = 0.0;
  std::vector<double> neighbour_support;  // a target: of those that move with it most
};

/// Infers which modes belong together, by expectation propagation: every target is predicted from
/// all others by the pose priors, its modes are weighed by that prediction, and so on.
/// Precondition: the model has pose priors.
PoseMarginals InferPose(const ForestModel& model, std::span<const float> context_posterior,
                        const TargetModes& modes);

/// Where the refinement puts a target, and how likely that is right to 10 cm.
struct RefinedPlace {
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();
  double confidence = 0.0;
};

/// A place where a target may be, with what its confidence is computed from.
struct PlaceCandidate {
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();
  std::array<float, PlaceConfidence::kFeatures> feature{};
  bool is_fused = false;  // modes and other targets joined; else a mode that stands apart
  int mode = -1;          // that it rests on most; -1: none
  std::optional<double> refined_confidence;  // of a fused place that the refinement moved
};
/// `refined` may be null: the fused place then stays where it is.
std::vector<PlaceCandidate> Candidates(const ProposalTarget& target, const PoseMarginals& marginals,
                                       size_t target_index, const std::vector<Mode>& modes,
                                       const RefinedPlace* refined = nullptr);
/// P(within 10 cm of the target).
double ComputeConfidence(const ProposalTarget& target, const PlaceCandidate& candidate);

/// Where the prediction and the likeliest mode meet when modes have this noise.
Eigen::Vector3d Fuse(const TargetMarginal& marginal, const std::vector<Mode>& modes,
                     double mode_noise_m);

}  // namespace ossa::forest
