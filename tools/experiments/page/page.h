#pragma once
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "tools/experiments/experiment.h"

namespace ossa::tools {

/// One page of a study that needs no other file: its tables, of each a plot of the columns that are
/// numbers, and the figures (.svg, .png) that lie in `folder`.
std::string ExperimentPage(std::string_view name, const std::vector<Table>& tables,
                           const std::filesystem::path& folder);

}  // namespace ossa::tools
