#pragma once
#include <span>
#include <string>
#include <vector>

namespace ossa::tools {

/// Origin and licences of the body and of the motion in `sources` (folders or files of mocap,
/// "authored"), for DatasetManifest::terms. A folder counts as the CMU's by its own name, not by
/// its parents'; the terms of other folders are unknown.
std::vector<std::string> ListTerms(std::span<const std::string> sources);

}  // namespace ossa::tools
