#pragma once
#include <optional>
#include <vector>

#include "depth/scene/planes.h"
#include "depth/scene/regions.h"

// The back of a seat, a box, a screen: things that somebody is behind, and that hang together with
// what shows of them.
namespace ossa::depth {

/// Where a region is all but one plane, that plane; nothing where it is not. `shape` is of the same
/// grid.
std::optional<FlatPlane> BoardOf(const Region& region, const RoomShape& shape);

/// What stands clearly behind a board, on average: no limb of somebody whose flat side that is.
bool StandsBehind(const PointGrid& grid, const Region& region, const FlatPlane& board);

}  // namespace ossa::depth
