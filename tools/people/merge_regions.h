#pragma once
#include <vector>

#include "tools/people/geometry.h"
#include "tools/people/options.h"
#include "tools/people/track.h"

// Merging connected regions of one person. `owner`: the track that each cell is predicted to belong
// to, as an index into `tracks`, -1 for none.
namespace ossa::people {

/// Removes from `owner` the regions that a track took over from a lost or partly hidden one: those
/// where the hidden track may come into view again (IsRatherOf), except a track's largest region.
void ReleaseReturning(const PointGrid& grid, const std::vector<Region>& regions,
                      const std::vector<Track>& tracks, double time_s,
                      const CandidateOptions& options, std::vector<int>& owner);

/// Merges small regions (extended hands, forearms cut off by the projector's shadow, legs below a
/// table) into the nearest large region within an arm's reach. Excluded are regions of different
/// tracks, regions behind a planar occluder, such as a person behind the back of a seat, and
/// regions where a lost or partly hidden track may come into view again behind the large one.
std::vector<Region> MergePieces(const PointGrid& grid, std::vector<Region> regions,
                                const RoomShape& shape, const std::vector<int>& owner,
                                const std::vector<Track>& tracks, double time_s,
                                const CandidateOptions& options = {});

/// Merges regions that are mostly owned by the same track (an arm of a nearer person may cut a body
/// in two), and regions that appear beside a partly occluded track. Largest first.
std::vector<Region> MergeByTracks(const PointGrid& grid, std::vector<Region> regions,
                                  const std::vector<int>& owner, const std::vector<Track>& tracks,
                                  double time_s, const CandidateOptions& options = {});

}  // namespace ossa::people
