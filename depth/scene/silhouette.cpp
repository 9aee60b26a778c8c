#include "depth/scene/silhouette.h"

#include <array>

#include "depth/scene/furniture_internal.h"

namespace ossa::depth {
namespace {

enum class Beside { kItself, kImageBorder, kFarther, kNearer };

// The surface next to a cell of the region in one direction of the image, beyond the shadow of an
// edge (the projector's baseline leaves several cells without measurements).
Beside LookBeside(const PointGrid& grid, const std::optional<FloorPlane>& floor,
                  const std::vector<uint8_t>& member, int from, std::array<int, 2> side,
                  const SilhouetteOptions& options) {
  const auto [dx, dy] = side;
  const int x = from % grid.width, y = from / grid.width;
  for (int i = 1; i <= options.shadow_cells; ++i) {
    if (!grid.Contains(x + i * dx, y + i * dy)) return Beside::kImageBorder;
    const int cell = grid.cell(x + i * dx, y + i * dy);
    if (member[static_cast<size_t>(cell)]) return Beside::kItself;
    if (!grid.valid(cell)) continue;
    if (grid.z(cell) > grid.z(from) - options.nearer_m) return Beside::kFarther;
    const bool on_floor = floor && floor->HeightOf(grid.at(cell).cast<double>()) <
                                       2 * HeightTolerance(*floor, grid.at(cell));
    return on_floor ? Beside::kFarther : Beside::kNearer;
  }
  return Beside::kFarther;
}

}  // namespace

double MeasureOccludedShare(const PointGrid& grid, const std::optional<FloorPlane>& floor,
                            const Region& region, const SilhouetteOptions& options) {
  std::vector<uint8_t> member(static_cast<size_t>(grid.cells()), 0);
  for (const int cell : region.cells) member[static_cast<size_t>(cell)] = 1;
  constexpr std::array<std::array<int, 2>, 4> kSides = {{{1, 0}, {-1, 0}, {0, 1}, {0, -1}}};
  double occluded = 0, rim = 0;
  for (const int cell : region.cells) {
    for (const auto& side : kSides) {
      const Beside beside = LookBeside(grid, floor, member, cell, side, options);
      rim += beside == Beside::kFarther || beside == Beside::kNearer ? 1 : 0;
      occluded += beside == Beside::kNearer ? 1 : 0;
    }
  }
  return rim > 0 ? occluded / rim : 0;
}

}  // namespace ossa::depth
