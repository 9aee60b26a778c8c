#pragma once
#include <optional>

#include "depth/scene/floor.h"
#include "depth/scene/regions.h"

namespace ossa::depth {

/// Share of a region's outline within the image where more of it may be out of sight: behind
/// something clearly nearer. The floor that it stands on hides nothing.
double HiddenShare(const PointGrid& grid, const std::optional<FloorPlane>& floor,
                   const Region& region);

}  // namespace ossa::depth
