#pragma once
#include <string_view>

#include "tools/experiments/experiment.h"
#include "tools/tracker/model_set.h"

namespace ossa::tools {

/// Loads the models of a study's tracker: --model and --database, else the shipped ones. Calls
/// context.warn for files that do not fit each other. Throws as ModelSet::Load() does.
tracker::ModelSet LoadModels(const ExperimentContext& context, std::string_view method);
/// The same with the given files.
tracker::ModelSet LoadModels(const ExperimentContext& context, const tracker::ModelFiles& files,
                             std::string_view method);

}  // namespace ossa::tools
