#pragma once
#include <cstdint>
#include <vector>

#include "tools/people/geometry.h"
#include "tools/people/options.h"

// Merging regions of one person whose middle is occluded. `owner`: the track that each cell is
// predicted to belong to, as an index below `tracks`, -1 for none.
namespace ossa::people {

/// Whether an occluder, and no view of the room behind, is on the line between two regions in the
/// image.
bool IsOccludedBetween(const PointGrid& grid, const Region& a, const Region& b,
                       const OcclusionOptions& options);

/// Whether two regions are at one place over the floor, one above the other. They are one person
/// whatever is between them, because people do not stand on each other.
bool IsOneAboveOther(const PointGrid& grid, const Region& a, const Region& b,
                     const OcclusionOptions& options = {});

/// Merges what is visible of a person at both sides of a nearer one, and above: regions of unowned
/// foreground (1 per cell) at about the same distance with only occluders between, or one above the
/// other.
std::vector<Region> MergeBesideOccluder(const PointGrid& grid, std::vector<Region> regions,
                                        const std::vector<uint8_t>& foreground,
                                        const std::vector<int>& owner, size_t tracks,
                                        const CandidateOptions& options = {});

/// Merges what is visible of a person above a table and below its top, with only nearer surface
/// between. Legs found below a track are assigned to that track in `owner`.
std::vector<Region> MergeBelowOccluder(const PointGrid& grid, std::vector<Region> regions,
                                       size_t tracks, std::vector<int>& owner,
                                       const OcclusionOptions& options = {});

}  // namespace ossa::people
