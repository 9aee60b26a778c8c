#pragma once
#include <optional>

#include "depth/scene/floor.h"
#include "depth/scene/regions.h"

namespace ossa::depth {

struct SilhouetteOptions {
  // Sensor: width of the shadow beside an edge, in which there is no reading, due to the baseline
  // to the projector; by hand, of 160 x 120 cells.
  int shadow_cells = 5;
  float nearer_m = 0.1F;  // sensor: depth difference of an occluder, > 0; noise is less
};

/// Share of a region's silhouette within the image, [0, 1], at which the region may be occluded:
/// the neighbouring surface is clearly nearer. The floor that it stands on does not count.
double MeasureOccludedShare(const PointGrid& grid, const std::optional<FloorPlane>& floor,
                            const Region& region, const SilhouetteOptions& options = {});

}  // namespace ossa::depth
