#pragma once
#include <Eigen/Core>
#include <array>
#include <filesystem>
#include <vector>

#include "depth/base/perceptron/train_perceptron.h"
#include "forest/forest.h"
#include "recon/refine/refinement_cascade.h"
#include "tools/learning/learn_refinement_stage.h"

namespace ossa::tools {

/// A training example of a stage: the person with the joints of the forest and the earlier stages,
/// the offsets to the true joints, the true bone lengths, and the bone lengths that earlier stages
/// would read.
struct RefinementExample {
  recon::SampledPerson person;
  recon::JointArray<Eigen::RowVector3f> offset{};  // the stage's target
  recon::BoneLengths bones_m{};
  recon::BoneLengths given_bones_m{};  // the true ones where nothing estimates them yet
};

struct RefinementExamples {
  std::vector<RefinementExample> all;  // of each person as it is, then from shifted places
  size_t people = 0;
};

/// Whether the people of data sets are seen by a camera under the ceiling. Throws InputError where
/// those of some are and those of others are not.
bool AreSeenFromAbove(const std::vector<std::filesystem::path>& datasets);

/// One person of each frame of the data sets of whom enough is seen, in order. Throws InputError
/// where there are too few to learn from.
RefinementExamples GatherRefinementExamples(const forest::ForestModel& model,
                                            const std::vector<std::filesystem::path>& datasets,
                                            const RefinementStageOptions& options);

/// How a network is learned from them: two layers, large batches, no dropout.
PerceptronTraining MakeNetworkOptions(const RefinementStageOptions& options, Eigen::Index outputs);

}  // namespace ossa::tools
