#include "depth/scene/regions.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "depth/scene/furniture_internal.h"
#include "depth/scene/planes.h"

namespace ossa::depth {
namespace {

using Eigen::Vector3f;

// Minimum area of a flat piece to be furniture or a wall: larger than the flattest part of a body
// appears at this distance. At 1 m the sensor resolves 1 cm of curvature, and a flat back has 0.15
// m2; from 3 m on a whole person appears flat.
double RequireRoomArea_m2(double z_m, const FurnitureOptions& options) {
  const double far_m = std::max(0.0, z_m - 1.0);
  return std::min(0.2 + 0.12 * far_m + 0.05 * far_m * far_m, options.person_m2);
}

double ComputeMeanDepth_m(const PointGrid& grid, const FlatPiece& piece) {
  double z_m = 0;
  for (const int cell : piece.cells) z_m += static_cast<double>(grid.z(cell));
  return z_m / static_cast<double>(piece.cells.size());
}

void MarkFlatPieces(const PointGrid& grid, const std::optional<FloorPlane>& floor,
                    const FurnitureOptions& options, RoomShape& shape) {
  const Eigen::Vector3d up =
      floor ? floor->coefficients.head<3>().eval() : Eigen::Vector3d::UnitY();
  const std::vector<FlatPiece> pieces =
      FlatPieces(grid, shape.room, options.person_m2);  // largest first
  std::vector<const FlatPiece*> walls;
  for (const FlatPiece& piece : pieces) {
    for (const int cell : piece.cells) {
      shape.flat[static_cast<size_t>(cell)] = 1;
      shape.plane_of[static_cast<size_t>(cell)] = static_cast<int>(shape.planes.size());
    }
    shape.planes.push_back(piece);
    const bool top = piece.normal.dot(up) > options.top_cosine;
    const bool large =
        piece.area_m2 >=
        (top ? options.top_m2 : RequireRoomArea_m2(ComputeMeanDepth_m(grid, piece), options));
    const bool of_wall = !large && std::any_of(walls.begin(), walls.end(), [&](const FlatPiece* w) {
      return LiesInPlaneOf(grid, piece, *w, options);
    });
    if (large) walls.push_back(&piece);
    if (large || of_wall) {
      for (const int cell : piece.cells) shape.room[static_cast<size_t>(cell)] = 1;
      for (const int cell : piece.cells) shape.in_plane[static_cast<size_t>(cell)] = of_wall;
    } else if (floor) {
      for (const int cell : LowFront(grid, *floor, pieces, piece, options))
        shape.room[static_cast<size_t>(cell)] = 1;
    }
  }
}

// The cells of each connected component, ascending. Cells are distributed in one pass over the
// grid, because sorting takes longer than the labelling.
std::vector<std::vector<int>> ConnectedCells(const PointGrid& grid,
                                             std::span<const uint8_t> ignore) {
  constexpr int kFree = -1, kNobodys = -2;  // by convention: not a component's index
  std::vector<int> piece_of(ignore.size());
  std::transform(ignore.begin(), ignore.end(), piece_of.begin(),
                 [](uint8_t ignored) { return ignored ? kNobodys : kFree; });
  std::vector<size_t> sizes;
  std::vector<int> front;
  for (int start = 0; start < grid.cells(); ++start) {
    if (piece_of[static_cast<size_t>(start)] != kFree || !grid.valid(start)) continue;
    const auto piece = static_cast<int>(sizes.size());
    front.assign(1, start);
    piece_of[static_cast<size_t>(start)] = piece;
    for (size_t i = 0; i < front.size(); ++i) {
      const int cell = front[i], x = cell % grid.width, y = cell / grid.width;
      for (const auto& step : kStepsOverGaps) {
        if (!grid.Contains(x + step[0], y + step[1])) continue;
        const int next = grid.cell(x + step[0], y + step[1]);
        int& piece_of_next = piece_of[static_cast<size_t>(next)];
        if (piece_of_next != kFree || !grid.valid(next) || !Continuous(grid, cell, next)) continue;
        piece_of_next = piece;
        front.push_back(next);
      }
    }
    sizes.push_back(front.size());
  }
  std::vector<std::vector<int>> pieces(sizes.size());
  for (size_t i = 0; i < sizes.size(); ++i) pieces[i].reserve(sizes[i]);
  for (int cell = 0; cell < grid.cells(); ++cell) {
    const int piece = piece_of[static_cast<size_t>(cell)];
    if (piece >= 0) pieces[static_cast<size_t>(piece)].push_back(cell);
  }
  return pieces;
}

}  // namespace

// Early exits for points clearly outside any tolerance.
bool IsOnOrBelow(const FloorPlane& floor, const Vector3f& p) {
  const double height_m = floor.HeightOf(p.cast<double>());
  return height_m < MostHeightTolerance(p) && height_m < HeightTolerance(floor, p);
}

RoomShape FindRoomSurfaces(const PointGrid& grid, const std::optional<FloorPlane>& floor,
                           const FurnitureOptions& options) {
  const auto cells = static_cast<size_t>(grid.cells());
  RoomShape shape{std::vector<uint8_t>(cells, 0),
                  std::vector<uint8_t>(cells, 0),
                  std::vector<uint8_t>(cells, 0),
                  std::vector<uint8_t>(cells, 0),
                  {},
                  std::vector<int>(cells, -1)};
  if (floor) {
    for (int i = 0; i < grid.cells(); ++i) {
      if (!grid.valid(i)) continue;
      shape.room[static_cast<size_t>(i)] = IsOnOrBelow(*floor, grid.at(i));
    }
    shape.floor = shape.room;
  }
  if (floor) MarkTops(grid, *floor, options, shape.room);
  MarkFlatPieces(grid, floor, options, shape);
  return shape;
}

Region MakeRegion(const PointGrid& grid, std::vector<int> cells) {
  Region region;
  if (!std::is_sorted(cells.begin(), cells.end())) std::sort(cells.begin(), cells.end());
  region.cells = std::move(cells);
  region.low_m = Vector3f::Constant(1e9F);
  region.high_m = Vector3f::Constant(-1e9F);
  region.mean_m = Vector3f::Zero();
  for (const int cell : region.cells) {
    region.low_m = region.low_m.cwiseMin(grid.at(cell));
    region.high_m = region.high_m.cwiseMax(grid.at(cell));
    region.mean_m += grid.at(cell);
    region.area_m2 += grid.Area(cell);
  }
  if (!region.cells.empty()) region.mean_m /= static_cast<float>(region.cells.size());
  return region;
}

Region UniteRegions(const PointGrid& grid, const Region& a, const Region& b) {
  std::vector<int> cells;
  cells.reserve(a.cells.size() + b.cells.size());
  std::merge(a.cells.begin(), a.cells.end(), b.cells.begin(), b.cells.end(),
             std::back_inserter(cells));
  return MakeRegion(grid, std::move(cells));
}

std::vector<Region> FindConnectedRegions(const PointGrid& grid, std::span<const uint8_t> ignore,
                                         float min_area_m2) {
  std::vector<Region> regions;
  for (std::vector<int>& cells : ConnectedCells(grid, ignore)) {
    Region region = MakeRegion(grid, std::move(cells));
    if (region.area_m2 >= min_area_m2) regions.push_back(std::move(region));
  }
  std::stable_sort(regions.begin(), regions.end(),
                   [](const Region& a, const Region& b) { return a.area_m2 > b.area_m2; });
  return regions;
}

double MeasureShare(const Region& region, const std::vector<uint8_t>& marked) {
  const auto count = std::count_if(region.cells.begin(), region.cells.end(), [&](int cell) {
    return marked[static_cast<size_t>(cell)] != 0;
  });
  return static_cast<double>(count) / static_cast<double>(std::max<size_t>(1, region.cells.size()));
}

}  // namespace ossa::depth
