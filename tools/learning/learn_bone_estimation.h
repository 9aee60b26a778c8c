#pragma once
#include <filesystem>
#include <vector>

#include "forest/forest.h"
#include "tools/learning/learn_refinement_stage.h"

namespace ossa::tools {

/// The cascade of `options.after`, which now also estimates how long people's bones are
/// (recon/refine/bone_estimation.h): learned from where its stages put the joints of the people of
/// data sets, and of their mirror images. The same bytes for any number of threads. Throws
/// InputError where too few people are seen.
recon::RefinementCascade LearnBoneEstimation(const forest::ForestModel& model,
                                             const std::vector<std::filesystem::path>& datasets,
                                             const RefinementStageOptions& options);

}  // namespace ossa::tools
