#pragma once
#include <optional>

#include "tools/people/geometry.h"
#include "tools/people/options.h"

// Planar occluders: seat backs, boxes and screens, which are connected with the visible parts of
// the people behind them.
namespace ossa::people {

/// The plane of a nearly planar region; nothing for others. `shape` is of the same grid.
std::optional<FlatPlane> FitWholePlane(const Region& region, const RoomShape& shape,
                                       const PlanarOccluderOptions& options = {});

/// Whether a region is clearly behind a plane, on average, and so cannot be a limb of a person with
/// that flat side.
bool StandsBehind(const PointGrid& grid, const Region& region, const FlatPlane& plane,
                  const PlanarOccluderOptions& options = {});

}  // namespace ossa::people
