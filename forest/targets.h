#pragma once
#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "forest/forest.h"

namespace ossa::forest {

/// The indices of the model's targets with these names. Throws InputError that names the model if
/// one is missing.
std::vector<size_t> FindTargets(const ForestModel& model, std::span<const std::string_view> names,
                                const std::string& model_name);

}  // namespace ossa::forest
