#pragma once
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <vector>

#include "depth/image/camera.h"
#include "depth/image/depth_frame.h"

namespace ossa::depth {

/// A depth image thinned to about 160 × 120 camera-space points: enough to tell people from rooms,
/// and sixteen times cheaper than the image itself.
struct PointGrid {
  int width = 0;                                  // cells
  int height = 0;                                 // cells
  int step = 1;                                   // pixels a cell, both ways
  Camera camera;                                  // of the full image
  std::vector<Eigen::Vector3f> point_m;           // row-major; z = 0 where nothing was measured
  float max_depth_m = 0;                          // what is farther counts as not measured,
  std::vector<uint8_t> beyond;                    // ... and is marked here
  Eigen::Vector3f up = Eigen::Vector3f::UnitY();  // by the floor, where one is known

  int cells() const { return width * height; }
  int cell(int x, int y) const { return y * width + x; }
  bool Contains(int x, int y) const { return x >= 0 && y >= 0 && x < width && y < height; }
  const Eigen::Vector3f& at(int cell) const { return point_m[static_cast<size_t>(cell)]; }
  float z(int cell) const { return point_m[static_cast<size_t>(cell)].z(); }
  bool valid(int cell) const { return z(cell) > 0; }
  bool farther(int cell) const { return beyond[static_cast<size_t>(cell)] != 0; }
  /// Cells that a length across the line of sight spans at depth z.
  float CellsOf(float length_m, float z_m) const {
    return length_m * static_cast<float>(camera.fx) / (z_m * static_cast<float>(step));
  }
  /// Where a point is over the floor, to the left and ahead: head and feet of one person are about
  /// at one place, also before a sensor that looks down.
  Eigen::Vector2f OnFloor(const Eigen::Vector3f& p_m) const {
    constexpr float kStraightDown = 0.8F;  // cosine; by hand: then down the image is ahead
    const bool down = up.z() < -kStraightDown;
    const Eigen::Vector3f ahead = down ? Eigen::Vector3f::UnitY() : Eigen::Vector3f::UnitZ();
    const Eigen::Vector3f left = up.cross(ahead).normalized();
    return {left.dot(p_m), left.cross(up).dot(p_m)};
  }
  /// Area of one cell's patch seen frontally, square metres.
  float Area(int cell) const {
    const float side = z(cell) * static_cast<float>(step);
    return side * side / static_cast<float>(camera.fx * camera.fy);
  }
};

/// From a cell to those beside it, columns and rows, and to those one farther on: a line of cells
/// without a measurement does not part a surface.
inline constexpr int kStepsOverGaps[8][2] = {{1, 0}, {-1, 0}, {0, 1}, {0, -1},
                                             {2, 0}, {-2, 0}, {0, 2}, {0, -2}};

/// Pixels that a cell is wide, in an image of so many columns.
int CellPixels(int image_width);

PointGrid MakePointGrid(const DepthView& depth, const Camera& camera, float max_depth_m);

/// How far two measurements of one flat surface may differ at depth z: the 2.9 mm × z² quantisation
/// steps of a structured-light sensor, thrice, above a floor of 2 cm.
inline float DepthTolerance(float z_m) { return 0.02F + 0.0087F * z_m * z_m; }

}  // namespace ossa::depth
