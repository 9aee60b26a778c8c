#include "tools/people/planar_occluder.h"

#include <algorithm>

namespace ossa::people {

std::optional<FlatPlane> FitWholePlane(const Region& region, const RoomShape& shape,
                                       const PlanarOccluderOptions& options) {
  if (region.area_m2 < options.min_m2) return std::nullopt;
  std::vector<int> cells_of(shape.planes.size(), 0);
  for (const int cell : region.cells) {
    const int plane = shape.plane_of[static_cast<size_t>(cell)];
    if (plane >= 0) ++cells_of[static_cast<size_t>(plane)];
  }
  const auto most = std::max_element(cells_of.begin(), cells_of.end());
  if (most == cells_of.end() ||
      *most < options.planar_share * static_cast<double>(region.cells.size()))
    return std::nullopt;
  return shape.planes[static_cast<size_t>(most - cells_of.begin())];
}

bool StandsBehind(const PointGrid& grid, const Region& region, const FlatPlane& plane,
                  const PlanarOccluderOptions& options) {
  double behind_m = 0, tolerance_m = 0;
  for (const int cell : region.cells) {
    const double inverse_per_m = plane.At(cell % grid.width, cell / grid.width);
    const auto z_m = static_cast<double>(grid.z(cell));
    if (inverse_per_m <= 0) continue;  // beyond the plane's horizon
    behind_m += z_m - 1 / inverse_per_m;
    tolerance_m += 0.5 * static_cast<double>(depth::DepthTolerance(grid.z(cell)));
  }
  return behind_m > tolerance_m + options.behind_m * static_cast<double>(region.cells.size());
}

}  // namespace ossa::people
