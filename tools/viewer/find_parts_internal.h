#pragma once
#include <cstdint>

#include "depth/image/depth_frame.h"
#include "depth/image/image.h"
#include "forest/forest.h"

namespace ossa::viewer {

/// The body part of each pixel of somebody, 0 elsewhere, as the forest alone sees it: what the
/// tracker makes with TrackerOptions::keep_parts, without its knowledge of frames before. For
/// frames in which people stand upright.
depth::Image<uint8_t> FindParts(const forest::ForestModel& model, const depth::DepthFrame& frame,
                                const depth::Image<uint8_t>& users);

}  // namespace ossa::viewer
