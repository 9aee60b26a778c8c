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

using ModesOfTargets = std::vector<std::vector<Mode>>;  // a list a target

/// What is believed of one target, in metres of camera space: what all others say of it, and what
/// that makes of its modes.
struct Belief : Prediction {
  std::vector<double> weight;      // of each mode: P(it is the target's), other targets heard
  std::vector<double> confidence;  // of each mode by itself
  double support() const;          // P(one of the modes is the target's)
};

/// Beliefs of all targets of one object under its likeliest arrangement.
struct Beliefs {
  std::vector<Belief> target;
  double margin = 0.0;           // of that arrangement against the next, nats
  double mean_confidence = 0.0;  // of the densest modes by themselves
  double mean_support = 0.0;
  std::vector<double> neighbour_support;  // a target: of those that move with it most
};

/// Which modes belong together: every target is predicted from all others by the model's
/// arrangements, its modes are weighed by that prediction, and so on. Precondition: the model has
/// arrangements.
Beliefs Agree(const ForestModel& model, std::span<const float> context_posterior,
              const ModesOfTargets& modes);

/// Where the refinement puts a target, and how likely that is right to 10 cm.
struct RefinedPlace {
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();
  double confidence = 0.0;
};

/// A place where a target may be, with what its confidence is computed from.
struct PlaceCandidate {
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();
  std::array<float, Agreement::kFeatures> feature{};
  bool is_fused = false;  // modes and other targets joined; else a mode that stands apart
  int mode = -1;          // that it rests on most; -1: none
  std::optional<double> refined_confidence;  // of a fused place that the refinement moved
};
/// `refined` may be null: the fused place then stays where it is.
std::vector<PlaceCandidate> Candidates(const ProposalTarget& target, const Beliefs& beliefs,
                                       size_t target_index, const std::vector<Mode>& modes,
                                       const RefinedPlace* refined = nullptr);
/// P(within 10 cm of the target).
double ConfidenceOf(const ProposalTarget& target, const PlaceCandidate& candidate);

/// Where the prediction and the likeliest mode meet when modes have this noise.
Eigen::Vector3d Fuse(const Belief& belief, const std::vector<Mode>& modes, double mode_noise_m);

}  // namespace ossa::forest
