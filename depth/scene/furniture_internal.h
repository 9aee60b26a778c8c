#pragma once
#include <vector>

#include "depth/scene/floor.h"
#include "depth/scene/planes.h"
#include "depth/scene/point_grid.h"
#include "depth/scene/regions.h"

// Detects furniture by properties that no body has; planes too large for a body are in regions.cpp.
namespace ossa::depth {

/// Height error of a measurement, due to depth error along the line of sight.
double HeightTolerance(const FloorPlane& floor, const Eigen::Vector3f& p);
/// A cheap upper bound of HeightTolerance for any floor: that of looking straight down.
double MostHeightTolerance(const Eigen::Vector3f& p);

/// Whether a patch cut off from a wall by people in front is in the wall's plane to within a
/// quantisation step.
bool LiesInPlaneOf(const PointGrid& grid, const FlatPiece& piece, const FlatPiece& wall,
                   const FurnitureOptions& options);

/// The front of a sofa, chest or box is often split by the legs of a person in front of it, and
/// each half may be as small as the flat side of a person. Together they are one plane that stands
/// on the floor, ends below the hips, where people are two narrow legs, and is wider than a person.
/// Returns the cells of such a front in the plane of `piece`, or none.
std::vector<int> LowFront(const PointGrid& grid, const FloorPlane& floor,
                          const std::vector<FlatPiece>& pieces, const FlatPiece& piece,
                          const FurnitureOptions& options);

/// Marks table tops and seats in `room`: surfaces of constant height, wider in both directions than
/// arms and laps. At grazing angles they are too noisy for a plane fit, but their height is
/// accurate.
void MarkTops(const PointGrid& grid, const FloorPlane& floor, const FurnitureOptions& options,
              std::vector<uint8_t>& room);

}  // namespace ossa::depth
