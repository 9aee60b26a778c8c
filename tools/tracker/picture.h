#pragma once
#include <filesystem>

#include "depth/image/depth_frame.h"
#include "tools/tracker/tracker.h"

namespace ossa::tracker {

/// Four panels side by side as a PNG: depth | body parts | raw joints | final skeleton. Filled
/// dots are tracked joints, rings inferred ones. Needs TrackerOptions::keep_parts for the parts.
void WritePicture(const std::filesystem::path& path, const depth::DepthFrame& frame,
                  const BodyFrame& bodies);

}  // namespace ossa::tracker
