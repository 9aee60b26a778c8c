#pragma once
#include <optional>

#include "depth/scene/floor.h"
#include "depth/scene/regions.h"

namespace ossa::depth {

struct SilhouetteOptions {
  // Sensor: so many cells beside an edge may have no reading, in the shadow that it casts from the
  // projector; by hand, of 160 x 120 cells.
  int shadow_cells = 5;
  float nearer_m = 0.1F;  // sensor: what is so much nearer occludes, > 0; the noise is less
};

/// Share of a region's silhouette within the image, [0, 1], along which more of the region may be
/// occluded: what is seen beside it is clearly nearer. The floor that it stands on occludes
/// nothing.
double MeasureOccludedShare(const PointGrid& grid, const std::optional<FloorPlane>& floor,
                            const Region& region, const SilhouetteOptions& options = {});

}  // namespace ossa::depth
