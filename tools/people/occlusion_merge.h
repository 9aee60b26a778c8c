#pragma once
#include <cstdint>
#include <vector>

#include "tools/people/geometry.h"
#include "tools/people/options.h"

// Regions of one person of whom something nearer occludes the middle become one. `owner` says which
// track each cell belongs to, as an index below `tracks`, -1 for none.
namespace ossa::people {

/// Whether nothing but nearer surface is on the way between two regions in the image.
bool IsOccludedBetween(const PointGrid& grid, const Region& a, const Region& b,
                       const OcclusionOptions& options);

/// Whether two regions are at one place over the floor, one above the other: nobody stands on
/// somebody else, whatever shows between them.
bool IsOneAbove(const PointGrid& grid, const Region& a, const Region& b,
                const OcclusionOptions& options = {});

/// What shows of somebody at either side of somebody nearer, and above: regions that are foreground
/// (1 a cell) and nobody's, one as far away as the other, with nothing but nearer surface on the
/// way between them, or one above the other.
std::vector<Region> MergeBesideOccluder(const PointGrid& grid, std::vector<Region> regions,
                                        const std::vector<uint8_t>& foreground,
                                        const std::vector<int>& owner, size_t tracks,
                                        const CandidateOptions& options = {});

/// What shows of somebody above a table and below its top: nothing but nearer surface on the way
/// between them. Legs that are found below a track become that track's in `owner`.
std::vector<Region> MergeBelowOccluder(const PointGrid& grid, std::vector<Region> regions,
                                       size_t tracks, std::vector<int>& owner,
                                       const OcclusionOptions& options = {});

}  // namespace ossa::people
