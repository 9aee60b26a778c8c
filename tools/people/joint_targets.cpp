#include "tools/people/joint_targets.h"

#include <fmt/format.h>

#include "depth/base/error.h"
#include "forest/targets.h"
#include "recon/body/parts.h"

namespace ossa::people {

JointTargets FindJointTargets(const forest::ForestModel& model, const std::string& model_name) {
  if (model.class_count() > recon::kLabelCount) {
    throw InputError(
        fmt::format("{}: expected at most {} classes, the labels of body parts, found {}",
                    model_name, recon::kLabelCount, model.class_count()));
  }
  const auto named = forest::FindTargets(model, recon::kJointNames, model_name);
  JointTargets targets{};
  for (size_t j = 0; j < targets.size(); ++j) targets[j] = static_cast<int>(named[j]);
  return targets;
}

}  // namespace ossa::people
