#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "depth/scene/point_grid.h"

namespace ossa::depth {

/// A plane is linear in inverse depth: 1 / z = slope_x x + slope_y y + at_zero over grid cells
/// (x, y).
struct FlatPlane {
  double slope_x = 0, slope_y = 0, at_zero = 0;  // 1/m a cell, 1/m a cell, 1/m

  double At(int x, int y) const { return slope_x * x + slope_y * y + at_zero; }
};

/// A flat connected component of the scene. The error of a structured-light sensor is constant in
/// inverse depth, so fits need no weights.
struct FlatPiece : FlatPlane {
  Eigen::Vector3d normal{0, 0, -1};  // unit, towards the sensor, camera space
  double area_m2 = 0;                // of the surface, not of its projection
  std::vector<int> cells;            // ascending
};

/// Segments flat pieces among the cells with ignore = 0, largest first: region growing from the
/// flattest blocks of 4 x 4 cells, with refits. A piece smaller than `person_m2`, the frontal area
/// of a large person, has no part in strips of other surfaces that cross its plane.
std::vector<FlatPiece> FlatPieces(const PointGrid& grid, const std::vector<uint8_t>& ignore,
                                  double person_m2);

}  // namespace ossa::depth
