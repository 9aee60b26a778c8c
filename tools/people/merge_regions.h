#pragma once
#include <vector>

#include "tools/people/geometry.h"
#include "tools/people/options.h"
#include "tools/people/track.h"

// Connected regions that belong to one person become one region. `owner` says which track each cell
// belongs to, as an index into `tracks`, -1 for none.
namespace ossa::people {

/// Hands held out, forearms cut off by the projector's shadow, legs below a table: small pieces
/// join the large region they are nearest to, if an arm could bridge the way. Pieces far behind do
/// not, nor those of another track, nor what shows of somebody over the back of a seat.
std::vector<Region> MergePieces(const PointGrid& grid, std::vector<Region> regions,
                                const RoomShape& shape, const std::vector<int>& owner,
                                size_t tracks, const CandidateOptions& options = {});

/// Regions that mostly cover where one track was belong together: an arm of somebody in front may
/// cut a body in two. So do pieces that come out where somebody half hidden is. Largest first.
std::vector<Region> MergeByTracks(const PointGrid& grid, std::vector<Region> regions,
                                  const std::vector<int>& owner, const std::vector<Track>& tracks,
                                  double time_s, const CandidateOptions& options = {});

}  // namespace ossa::people
