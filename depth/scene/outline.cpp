#include "depth/scene/outline_internal.h"

#include "depth/scene/furniture_internal.h"

namespace ossa::depth {
namespace {

enum class Beside { kItself, kBorder, kFree, kHidden };

// What is seen from a cell of the region in one direction of the image, over the shadow that an
// edge casts.
Beside Look(const PointGrid& grid, const std::optional<FloorPlane>& floor,
            const std::vector<uint8_t>& member, int from, int dx, int dy) {
  constexpr int kShadow = 5;         // cells
  constexpr float kNearer_m = 0.1F;  // beyond noise
  const int x = from % grid.width, y = from / grid.width;
  for (int i = 1; i <= kShadow; ++i) {
    if (!grid.Contains(x + i * dx, y + i * dy)) return Beside::kBorder;
    const int cell = grid.cell(x + i * dx, y + i * dy);
    if (member[static_cast<size_t>(cell)]) return Beside::kItself;
    if (!grid.valid(cell)) continue;
    if (grid.z(cell) > grid.z(from) - kNearer_m) return Beside::kFree;
    const bool on_floor = floor && floor->HeightOf(grid.at(cell).cast<double>()) <
                                       2 * HeightTolerance(*floor, grid.at(cell));
    return on_floor ? Beside::kFree : Beside::kHidden;
  }
  return Beside::kFree;
}

}  // namespace

double HiddenShare(const PointGrid& grid, const std::optional<FloorPlane>& floor,
                   const Region& region) {
  std::vector<uint8_t> member(static_cast<size_t>(grid.cells()), 0);
  for (const int cell : region.cells) member[static_cast<size_t>(cell)] = 1;
  constexpr int kSides[4][2] = {{1, 0}, {-1, 0}, {0, 1}, {0, -1}};
  double hidden = 0, rim = 0;
  for (const int cell : region.cells) {
    for (const auto& side : kSides) {
      const Beside beside = Look(grid, floor, member, cell, side[0], side[1]);
      rim += beside == Beside::kFree || beside == Beside::kHidden ? 1 : 0;
      hidden += beside == Beside::kHidden ? 1 : 0;
    }
  }
  return rim > 0 ? hidden / rim : 0;
}

}  // namespace ossa::depth
