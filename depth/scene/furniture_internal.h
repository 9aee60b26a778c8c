#pragma once
#include <vector>

#include "depth/scene/floor.h"
#include "depth/scene/planes.h"
#include "depth/scene/point_grid.h"
#include "depth/scene/regions.h"

// Furniture told by what no body has: planes too large are regions.cpp's.
namespace ossa::depth {

/// Height error of a measurement: depth errors run along the line of sight.
double HeightTolerance(const FloorPlane& floor, const Eigen::Vector3f& p);
/// No HeightTolerance there is larger, whatever the floor: that of looking straight down. Cheap.
double MostHeightTolerance(const Eigen::Vector3f& p);

/// A piece of a wall that people in front have cut off lies in the wall's plane to a step of the
/// sensor.
bool LiesInPlaneOf(const PointGrid& grid, const FlatPiece& piece, const FlatPiece& wall,
                   const FurnitureOptions& options);

/// The front of a sofa, a chest or a box is often cut in two by the legs of who stands before it,
/// and each half may be as small as the flat side of a person. But together they are one plane that
/// stands on the floor, ends below the hips, where people are two thin legs, and is wider than a
/// person. The cells of such a front in the plane of `piece`, or nothing.
std::vector<int> LowFront(const PointGrid& grid, const FloorPlane& floor,
                          const std::vector<FlatPiece>& pieces, const FlatPiece& piece,
                          const FurnitureOptions& options);

/// Marks table tops and seats in `room`: surfaces of one height, wider both ways than arms and laps
/// are. Seen at a grazing angle they are too rough for a plane fit, but their height is as sharp as
/// ever.
void MarkTops(const PointGrid& grid, const FloorPlane& floor, const FurnitureOptions& options,
              std::vector<uint8_t>& room);

}  // namespace ossa::depth
