#pragma once
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "tools/experiments/experiment.h"

namespace ossa::tools {

/// A self-contained HTML page of a study: its tables, a plot of the numeric columns of each, and
/// the figures (.svg, .png) in `folder`.
std::string ExperimentPage(std::string_view name, const std::vector<Table>& tables,
                           const std::filesystem::path& folder);

}  // namespace ossa::tools
