#include "tools/experiments/context_models.h"

namespace ossa::tools {

tracker::ModelSet LoadModels(const ExperimentContext& context, std::string_view method) {
  tracker::ModelFiles files;
  files.forest = context.model.string();
  files.database = context.database.string();
  return LoadModels(context, files, method);
}

tracker::ModelSet LoadModels(const ExperimentContext& context, const tracker::ModelFiles& files,
                             std::string_view method) {
  tracker::ModelSet models = tracker::ModelSet::Load(files, method);
  for (const std::string& warning : models.warnings) {
    if (context.warn) context.warn(warning);
  }
  return models;
}

}  // namespace ossa::tools
