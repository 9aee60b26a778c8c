#pragma once
#include <optional>

#include "depth/scene/floor.h"
#include "depth/scene/regions.h"

namespace ossa::depth {

/// Share of a region's silhouette within the image, [0, 1], along which more of the region may be
/// occluded: what is seen beside it is clearly nearer. The floor that it stands on occludes
/// nothing.
double MeasureOccludedShare(const PointGrid& grid, const std::optional<FloorPlane>& floor,
                            const Region& region);

}  // namespace ossa::depth
