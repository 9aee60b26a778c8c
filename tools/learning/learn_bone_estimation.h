#pragma once
#include <filesystem>
#include <vector>

#include "forest/forest.h"
#include "tools/learning/learn_refinement_stage.h"

namespace ossa::tools {

/// Adds an estimator of bone lengths (recon/refine/bone_estimation.h) to the cascade of
/// `options.after`: learned from the joints of its stages for the people of data sets, and of their
/// mirror images. The same bytes for any number of threads. Throws
/// InputError where too few people are seen.
recon::RefinementCascade LearnBoneEstimation(const forest::ForestModel& model,
                                             const std::vector<std::filesystem::path>& datasets,
                                             const RefinementStageOptions& options);

}  // namespace ossa::tools
