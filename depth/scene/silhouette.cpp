#include "depth/scene/silhouette.h"

#include "depth/scene/furniture_internal.h"

namespace ossa::depth {
namespace {

enum class Beside { kItself, kImageBorder, kFarther, kNearer };

// What is beside a cell of the region in one direction of the image, beyond the shadow that an edge
// casts (the projector's baseline leaves up to so many cells without a measurement).
Beside LookBeside(const PointGrid& grid, const std::optional<FloorPlane>& floor,
                  const std::vector<uint8_t>& member, int from, int dx, int dy) {
  constexpr int kShadow = 5;         // cells, by hand
  constexpr float kNearer_m = 0.1F;  // by hand: beyond the noise of structured light
  const int x = from % grid.width, y = from / grid.width;
  for (int i = 1; i <= kShadow; ++i) {
    if (!grid.Contains(x + i * dx, y + i * dy)) return Beside::kImageBorder;
    const int cell = grid.cell(x + i * dx, y + i * dy);
    if (member[static_cast<size_t>(cell)]) return Beside::kItself;
    if (!grid.valid(cell)) continue;
    if (grid.z(cell) > grid.z(from) - kNearer_m) return Beside::kFarther;
    const bool on_floor = floor && floor->HeightOf(grid.at(cell).cast<double>()) <
                                       2 * HeightTolerance(*floor, grid.at(cell));
    return on_floor ? Beside::kFarther : Beside::kNearer;
  }
  return Beside::kFarther;
}

}  // namespace

double MeasureOccludedShare(const PointGrid& grid, const std::optional<FloorPlane>& floor,
                            const Region& region) {
  std::vector<uint8_t> member(static_cast<size_t>(grid.cells()), 0);
  for (const int cell : region.cells) member[static_cast<size_t>(cell)] = 1;
  constexpr int kSides[4][2] = {{1, 0}, {-1, 0}, {0, 1}, {0, -1}};
  double occluded = 0, rim = 0;
  for (const int cell : region.cells) {
    for (const auto& side : kSides) {
      const Beside beside = LookBeside(grid, floor, member, cell, side[0], side[1]);
      rim += beside == Beside::kFarther || beside == Beside::kNearer ? 1 : 0;
      occluded += beside == Beside::kNearer ? 1 : 0;
    }
  }
  return rim > 0 ? occluded / rim : 0;
}

}  // namespace ossa::depth
