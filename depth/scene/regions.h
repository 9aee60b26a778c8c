#pragma once
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "depth/scene/floor.h"
#include "depth/scene/planes.h"
#include "depth/scene/point_grid.h"

namespace ossa::depth {

/// Whether a measurement (camera space, metres) lies within the height tolerance of the floor.
bool IsOnOrBelow(const FloorPlane& floor, const Eigen::Vector3f& p);

/// Criteria for planes that are furniture or walls, not people. Lengths and areas are > 0, cosines
/// and shares in [0, 1]. Constants: where a line names no other origin ("anthropometry", "sensor":
/// structured light), set by hand while developing on rendered rooms with validation subjects
/// (`ossa experiment indoor-scenes`); no sweep is recorded.
struct FurnitureOptions {
  double person_m2 = 0.85;  // anthropometry: frontal area of a large person
  double top_cosine = 0.9;  // cosine of the normal to the vertical: body surfaces are steeper,
  double top_m2 = 0.12;     // ... and smaller ones may be a lap or a stretched arm
  // Pieces of the same plane.
  double same_normal = 0.97;         // cosine: 14 degrees
  double same_depth_per_m = 2.9e-3;  // sensor: one step of the Kinect v1 in inverse depth
  // The front of a sofa, a chest or a box that stands on the floor.
  double upright_cosine = 0.35;  // cosine of the normal to the vertical, at most
  double front_top_m = 0.65;     // anthropometry: below the hips of adults, 0.8 m and more
  double front_foot_m = 0.2;     // height of its lower edge; anthropometry: below a knee
  double front_width_m = 0.9;    // anthropometry: wider than two legs
  double front_filled = 0.55;    // share of its bounding box: two legs fill less
  // Table tops and seats, by their height over the floor.
  float min_top_height_m = 0.3F, max_top_height_m = 1.3F;  // people lying on the floor are lower
  float level = 0.4F;  // times the cell spacing: a slope of 22 degrees
  double min_level_m2 = 0.25, min_level_width_m = 0.25;  // anthropometry: laps and arms are smaller
};

/// Classification of each cell by shape alone (1 = yes).
struct RoomShape {
  std::vector<uint8_t> floor;
  std::vector<uint8_t> room;      // the floor, and planes too large for a person: walls,
                                  // ceilings, doors, table tops
  std::vector<uint8_t> in_plane;  // of the room only because it is in the plane of such a surface
  std::vector<uint8_t> flat;      // on a flat piece of any size
  std::vector<FlatPlane> planes;  // of all flat pieces
  std::vector<int> plane_of;      // plane index of each cell, -1 for none
};
RoomShape FindRoomSurfaces(const PointGrid& grid, const std::optional<FloorPlane>& floor,
                           const FurnitureOptions& options = {});

/// A connected component of the surface: cells in ascending order.
struct Region {
  std::vector<int> cells;
  Eigen::Vector3f low_m = Eigen::Vector3f::Zero(), high_m = Eigen::Vector3f::Zero();  // bounds
  Eigen::Vector3f mean_m = Eigen::Vector3f::Zero();
  float area_m2 = 0;  // frontal area
};

Region MakeRegion(const PointGrid& grid, std::vector<int> cells);

/// The union of two disjoint regions.
Region UniteRegions(const PointGrid& grid, const Region& a, const Region& b);

/// Connected components of the cells with ignore = 0, split at depth discontinuities; largest
/// first.
std::vector<Region> FindConnectedRegions(const PointGrid& grid, std::span<const uint8_t> ignore,
                                         float min_area_m2);

/// Whether neighbouring cells, or measurements at that distance, with these depths may be on one
/// body.
inline bool Continuous(float a_m, float b_m) {
  // A thigh or forearm recedes by at most about 4 cm per cell; quantisation is added.
  return std::abs(a_m - b_m) < 0.04F + 0.5F * DepthTolerance(std::min(a_m, b_m));
}
inline bool Continuous(const PointGrid& grid, int cell_a, int cell_b) {
  return Continuous(grid.z(cell_a), grid.z(cell_b));
}

/// Share of the region's cells that are marked, [0, 1].
double MeasureShare(const Region& region, const std::vector<uint8_t>& marked);

}  // namespace ossa::depth
