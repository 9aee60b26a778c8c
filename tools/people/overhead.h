#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "tools/people/head_detector.h"

// People as a camera under the ceiling sees them: heads on top, shoulders around and below.
namespace ossa::people {

/// What stands above the floor: cells with ignored = 0 that are side by side in the image, however
/// deep the step between them, for a head hides its neck and an arm what is under it. Largest
/// first.
std::vector<Region> FindRegionsFromAbove(const PointGrid& grid, const FloorPlane& floor,
                                         std::span<const uint8_t> ignored, float speck_m2,
                                         const OverheadOptions& options);

/// Heads of a region, best first: tops of about 20 cm with everything around them lower.
std::vector<HeadBlob> FindHeadsFromAbove(const PointGrid& grid, const FloorPlane& floor,
                                         const Region& region, const OverheadOptions& options);

/// What of a region may belong to whose head that is: what is joined to it within a limb's reach
/// over the floor, by steps in depth under head and trunk only. A hand before a wall or over a
/// cupboard is beside it in the image; further out a limb is one surface.
Region KeepWithinReach(const PointGrid& grid, const Region& region, const HeadBlob& head,
                       const OverheadOptions& options);

}  // namespace ossa::people
