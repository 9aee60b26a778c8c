#pragma once
#include <string_view>

#include "tools/experiments/experiment.h"
#include "tools/tracker/model_set.h"

namespace ossa::tools {

/// What a study's tracker runs with: --model and --database, else what ossa ships. Tells
/// context.warn of what does not belong together. Throws as ModelSet::Load does.
tracker::ModelSet LoadModels(const ExperimentContext& context, std::string_view method);
/// The same of files that are named.
tracker::ModelSet LoadModels(const ExperimentContext& context, const tracker::ModelFiles& files,
                             std::string_view method);

}  // namespace ossa::tools
