#include "depth/scene/boards_internal.h"

#include <algorithm>

namespace ossa::depth {

std::optional<FlatPlane> BoardOf(const Region& region, const RoomShape& shape) {
  constexpr float kLeast_m2 = 0.08F;  // less is the flat side of a limb or a head
  constexpr double kAllBut = 0.85;    // edges are never flat
  if (region.area_m2 < kLeast_m2) return std::nullopt;
  std::vector<int> cells_of(shape.planes.size(), 0);
  for (const int cell : region.cells) {
    const int plane = shape.plane_of[static_cast<size_t>(cell)];
    if (plane >= 0) ++cells_of[static_cast<size_t>(plane)];
  }
  const auto most = std::max_element(cells_of.begin(), cells_of.end());
  if (most == cells_of.end() || *most < kAllBut * static_cast<double>(region.cells.size()))
    return std::nullopt;
  return shape.planes[static_cast<size_t>(most - cells_of.begin())];
}

bool StandsBehind(const PointGrid& grid, const Region& region, const FlatPlane& board) {
  constexpr double kClearly_m = 0.1;  // a chin and a neck lie less far behind a chest
  double behind_m = 0, tolerance_m = 0;
  for (const int cell : region.cells) {
    const double inverse_1_m = board.At(cell % grid.width, cell / grid.width);
    const auto z_m = static_cast<double>(grid.z(cell));
    if (inverse_1_m <= 0) continue;  // beyond the plane's horizon
    behind_m += z_m - 1 / inverse_1_m;
    tolerance_m += 0.5 * static_cast<double>(DepthTolerance(grid.z(cell)));
  }
  return behind_m > tolerance_m + kClearly_m * static_cast<double>(region.cells.size());
}

}  // namespace ossa::depth
