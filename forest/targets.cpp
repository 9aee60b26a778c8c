#include "forest/targets.h"

#include <algorithm>

#include "depth/base/error.h"

namespace ossa::forest {

std::vector<size_t> FindTargets(const ForestModel& model, std::span<const std::string_view> names,
                                const std::string& model_name) {
  std::vector<size_t> targets;
  for (const std::string_view name : names) {
    const auto found =
        std::find_if(model.targets().begin(), model.targets().end(),
                     [&](const ProposalTarget& target) { return target.name == name; });
    if (found == model.targets().end()) {
      throw InputError(model_name + ": targets: expected one named '" + std::string(name) +
                       "', found none");
    }
    targets.push_back(static_cast<size_t>(found - model.targets().begin()));
  }
  return targets;
}

}  // namespace ossa::forest
