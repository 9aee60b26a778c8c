#include "depth/scene/point_grid.h"

#include <algorithm>

namespace ossa::depth {
namespace {

// The first valid reading of a few fixed pixels of the cell. Averages would invent points between a
// person and the wall behind.
uint16_t ReadFirstDepth(const DepthView& depth, int u0, int v0, int step, uint16_t max_mm) {
  const int middle = step / 2;
  const int places[5][2] = {
      {middle, middle}, {0, 0}, {step - 1, step - 1}, {step - 1, 0}, {0, step - 1}};
  for (const auto& place : places) {
    const int u = std::min(u0 + place[0], depth.width - 1);
    const int v = std::min(v0 + place[1], depth.height - 1);
    const uint16_t mm = depth.at(u, v);
    if (mm > 0 && mm <= max_mm) return mm;
  }
  return 0;
}

// By hand: cells of two pixels for 320 columns and four for 640, about 1.5 cm at 2 m.
constexpr int kCellsInRow = 160;  // cells

}  // namespace

int CellPixels(int image_width) {
  // Rounded: 474 columns give 158 cells per row, not 237.
  return std::max(1, (image_width + kCellsInRow / 2) / kCellsInRow);
}

PointGrid MakePointGrid(const DepthView& depth, const Camera& camera, float max_depth_m) {
  PointGrid grid;
  grid.step = CellPixels(depth.width);
  grid.width = (depth.width + grid.step - 1) / grid.step;
  grid.height = (depth.height + grid.step - 1) / grid.step;
  grid.camera = camera;
  grid.point_m.assign(static_cast<size_t>(grid.cells()), Eigen::Vector3f::Zero());
  grid.beyond.assign(grid.point_m.size(), 0);
  grid.max_depth_m = max_depth_m;
  const auto max_mm = static_cast<uint16_t>(std::clamp(max_depth_m * 1000.0F, 1.0F, 65535.0F));
  for (int y = 0; y < grid.height; ++y) {
    for (int x = 0; x < grid.width; ++x) {
      const int u = x * grid.step, v = y * grid.step;
      const uint16_t mm = ReadFirstDepth(depth, u, v, grid.step, max_mm);
      if (mm == 0) {
        const int middle = grid.step / 2;
        grid.beyond[static_cast<size_t>(grid.cell(x, y))] =
            depth.at(std::min(u + middle, depth.width - 1),
                     std::min(v + middle, depth.height - 1)) > max_mm;
        continue;
      }
      const double half = 0.5 * (grid.step - 1);
      grid.point_m[static_cast<size_t>(grid.cell(x, y))] =
          BackProject(camera, u + half, v + half, mm).cast<float>();
    }
  }
  return grid;
}

}  // namespace ossa::depth
