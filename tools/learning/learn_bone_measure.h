#pragma once
#include <filesystem>
#include <vector>

#include "forest/forest.h"
#include "tools/learning/learn_close_look.h"

namespace ossa::tools {

/// The look of `options.after`, which now also judges how long people's bones are
/// (recon/refine/bone_measure.h): learned from where its glances put the joints of the people of
/// data sets, and of their mirror images. The same bytes for any number of threads. Throws
/// InputError where too few people are seen.
recon::CloseLook LearnBoneMeasure(const forest::ForestModel& model,
                                  const std::vector<std::filesystem::path>& datasets,
                                  const CloseLookOptions& options);

}  // namespace ossa::tools
