#pragma once
#include <optional>

#include "tools/people/geometry.h"
#include "tools/people/options.h"

// The back of a seat, a box, a screen: things that somebody is behind, and that hang together with
// what shows of them.
namespace ossa::people {

/// Where a region is all but one plane, that plane; nothing where it is not. `shape` is of the same
/// grid.
std::optional<FlatPlane> FitWholePlane(const Region& region, const RoomShape& shape,
                                       const PlanarOccluderOptions& options = {});

/// Whether a region is clearly behind a plane, on average: no limb of somebody whose flat side that
/// is.
bool StandsBehind(const PointGrid& grid, const Region& region, const FlatPlane& plane,
                  const PlanarOccluderOptions& options = {});

}  // namespace ossa::people
