#include "tools/experiments/context_models.h"

namespace ossa::tools {

tracker::ModelSet LoadModels(const ExperimentContext& context, std::string_view method) {
  tracker::ModelFiles files;
  files.forest = context.model.string();
  files.database = context.database.string();
  return tracker::ModelSet::Load(files, method);
}

}  // namespace ossa::tools
