#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "tools/people/head_detector.h"

// Person detection for a camera under the ceiling: heads on top, shoulders around and below.
namespace ossa::people {

/// Regions above the floor: cells with ignored = 0 that are adjacent in the image, whatever the
/// depth step between them, because a head occludes its neck and an arm what is below it. Largest
/// first.
std::vector<Region> FindRegionsFromAbove(const PointGrid& grid, const FloorPlane& floor,
                                         std::span<const uint8_t> ignored, float speck_m2,
                                         const OverheadOptions& options);

/// Heads of a region, best first: level discs of about 20 cm with everything around them lower.
std::vector<HeadBlob> FindHeadsFromAbove(const PointGrid& grid, const FloorPlane& floor,
                                         const Region& region, const OverheadOptions& options);

/// The cells of a region that may belong to the person with this head: connected to it within a
/// limb's reach over the floor. Depth steps are crossed near head and trunk only, because a hand in
/// front of a wall or above a cupboard is adjacent to it in the image.
Region KeepWithinReach(const PointGrid& grid, const Region& region, const HeadBlob& head,
                       const OverheadOptions& options);

}  // namespace ossa::people
