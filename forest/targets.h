#pragma once
#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "forest/forest.h"

namespace ossa::forest {

/// Which of the model's targets bears each of the names. Throws InputError that names the model
/// where none does.
std::vector<size_t> FindTargets(const ForestModel& model, std::span<const std::string_view> names,
                                const std::string& model_name);

}  // namespace ossa::forest
