#pragma once
#include <span>
#include <string>
#include <vector>

namespace ossa::tools {

/// Where the body and the motion of these sources (folders or files of mocap, "authored") come from
/// and under which terms: DatasetManifest::terms. A folder is the CMU's by its own name, whatever
/// the folders that it is in are called: of all others ossa knows no terms.
std::vector<std::string> ListTerms(std::span<const std::string> sources);

}  // namespace ossa::tools
