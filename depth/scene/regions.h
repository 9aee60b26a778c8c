#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "depth/scene/floor.h"
#include "depth/scene/planes.h"
#include "depth/scene/point_grid.h"

namespace ossa::depth {

/// Whether a measurement (camera space, metres) lies within the height tolerance of the floor.
bool OnOrUnder(const FloorPlane& floor, const Eigen::Vector3f& p);

/// What shape alone says of each cell (1 = yes).
struct RoomShape {
  std::vector<uint8_t> floor;
  std::vector<uint8_t> room;      // the floor, and planes too large to be a person's side: walls,
                                  // ceilings, doors, table tops
  std::vector<uint8_t> flat;      // on a flat piece of any size
  std::vector<FlatPlane> planes;  // of all flat pieces
  std::vector<int> plane_of;      // which of them a cell lies on, -1 for none
};
RoomShape FindRoomSurfaces(const PointGrid& grid, const std::optional<FloorPlane>& floor);

/// A connected piece of surface: cells in ascending order.
struct Region {
  std::vector<int> cells;
  Eigen::Vector3f low_m, high_m;  // bounds
  Eigen::Vector3f mean_m;
  float area_m2 = 0;  // as seen frontally
};

Region MakeRegion(const PointGrid& grid, std::vector<int> cells);

/// Two regions without a common cell as one.
Region UniteRegions(const PointGrid& grid, const Region& a, const Region& b);

/// Connected pieces of the cells with ignore = 0, cut where depth jumps; largest first.
std::vector<Region> FindConnectedRegions(const PointGrid& grid, std::span<const uint8_t> ignore,
                                         float min_area_m2);

/// True when neighbouring cells, or measurements as near to each other, of these depths may lie on
/// one body.
bool Continuous(const PointGrid& grid, int cell_a, int cell_b);
bool Continuous(float a_m, float b_m);

/// Share of the region's cells that are marked, [0, 1].
double MeasureShare(const Region& region, const std::vector<uint8_t>& marked);

}  // namespace ossa::depth
