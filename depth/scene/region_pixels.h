#pragma once
#include <cstdint>
#include <vector>

#include "depth/image/depth_frame.h"
#include "depth/scene/point_grid.h"
#include "depth/scene/regions.h"

namespace ossa::depth {

/// Full-resolution pixels (v * width + u, ascending) of a region of cells: each pixel belongs to
/// the neighbouring cell nearest in depth.
std::vector<int32_t> CollectPixels(const DepthFrame& frame, const PointGrid& grid,
                                   const Region& region);

}  // namespace ossa::depth
