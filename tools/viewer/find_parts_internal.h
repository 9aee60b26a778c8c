#pragma once
#include <cstdint>

#include "depth/image/depth_frame.h"
#include "depth/image/image.h"
#include "forest/forest.h"

namespace ossa::viewer {

/// The body part of each pixel of a person by the forest, 0 elsewhere: as
/// TrackerOptions::keep_parts gives them, but without the state of earlier frames. For frames in
/// which people stand upright.
depth::Image<uint8_t> FindParts(const forest::ForestModel& model, const depth::DepthFrame& frame,
                                const depth::Image<uint8_t>& users);

}  // namespace ossa::viewer
