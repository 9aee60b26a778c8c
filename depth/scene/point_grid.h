#pragma once
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <vector>

#include "depth/image/camera.h"
#include "depth/image/depth_frame.h"

namespace ossa::depth {

/// A depth image subsampled to about 160 × 120 camera-space points: enough to separate people from
/// rooms, at a sixteenth of the cost.
struct PointGrid {
  int width = 0;                                  // cells
  int height = 0;                                 // cells
  int step = 1;                                   // pixels per cell, both ways
  Camera camera;                                  // camera of the full image
  std::vector<Eigen::Vector3f> point_m;           // row-major; z = 0 where nothing was measured
  float max_depth_m = 0;                          // farther points count as not measured,
  std::vector<uint8_t> beyond;                    // ... and are marked here
  Eigen::Vector3f up = Eigen::Vector3f::UnitY();  // from the floor, if known

  int cells() const { return width * height; }
  int cell(int x, int y) const { return y * width + x; }
  bool Contains(int x, int y) const { return x >= 0 && y >= 0 && x < width && y < height; }
  const Eigen::Vector3f& at(int cell) const { return point_m[static_cast<size_t>(cell)]; }
  float z(int cell) const { return point_m[static_cast<size_t>(cell)].z(); }
  bool valid(int cell) const { return z(cell) > 0; }
  bool farther(int cell) const { return beyond[static_cast<size_t>(cell)] != 0; }
  /// Number of cells of a length perpendicular to the line of sight at depth z.
  float CellsOf(float length_m, float z_m) const {
    return length_m * static_cast<float>(camera.fx) / (z_m * static_cast<float>(step));
  }
  /// Horizontal position of a point, to the left and forwards: head and feet of a person are at
  /// about the same position, also for a sensor that looks down.
  Eigen::Vector2f OnFloor(const Eigen::Vector3f& p_m) const {
    constexpr float kStraightDown = 0.8F;  // cosine; by hand: beyond, down in the image is forwards
    const bool down = up.z() < -kStraightDown;
    const Eigen::Vector3f ahead = down ? Eigen::Vector3f::UnitY() : Eigen::Vector3f::UnitZ();
    const Eigen::Vector3f left = up.cross(ahead).normalized();
    return {left.dot(p_m), left.cross(up).dot(p_m)};
  }
  /// Area of a cell's patch if frontal, square metres.
  float Area(int cell) const {
    const float side = z(cell) * static_cast<float>(step);
    return side * side / static_cast<float>(camera.fx * camera.fy);
  }
};

/// Offsets to the neighbours of a cell, and to those one cell farther: a line of cells without
/// measurements does not separate a surface.
inline constexpr int kStepsOverGaps[8][2] = {{1, 0}, {-1, 0}, {0, 1}, {0, -1},
                                             {2, 0}, {-2, 0}, {0, 2}, {0, -2}};

/// Width of a cell in pixels, for an image of `image_width` columns.
int CellPixels(int image_width);

PointGrid MakePointGrid(const DepthView& depth, const Camera& camera, float max_depth_m);

/// Largest difference of two measurements of one flat surface at depth z: three quantisation steps
/// of a structured-light sensor, 2.9 mm × z² each, plus 2 cm.
inline float DepthTolerance(float z_m) { return 0.02F + 0.0087F * z_m * z_m; }

}  // namespace ossa::depth
