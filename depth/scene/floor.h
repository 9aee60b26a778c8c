#pragma once
#include <Eigen/Core>
#include <optional>

#include "depth/scene/point_grid.h"

namespace ossa::depth {

/// The Kinect SDK's floor clip plane: a x + b y + c z + d = 0 with unit normal pointing up; d is
/// the sensor's height over the floor, metres.
struct FloorPlane {
  Eigen::Vector4d coefficients{0, 1, 0, 0};

  double HeightOf(const Eigen::Vector3d& position_m) const {
    return coefficients.head<3>().dot(position_m) + coefficients[3];
  }
  /// Downward tilt of the sensor, radians (negative: up).
  double TiltDown_rad() const;
};

/// Constants: set by hand for sensors in homes: on shelves, tables and tripods.
struct FloorOptions {
  Eigen::Vector3d up = Eigen::Vector3d::UnitY();  // approximate; unit vector, camera space
  double max_tilt_rad = 0.79;  // the sensor's tilt and roll stay below 45 degrees
  double min_height_m = 0.25;  // height of the sensor over the floor
  double max_height_m = 3.5;
  double min_area_m2 = 0.5;       // visible floor area, in squares of 10 cm
  double max_share_below = 0.03;  // share of all points: few are below a floor (reflections)
  // Points below, per point on the plane. In 64 ITOP and 300 rendered stills floors had 0.01 at
  // most; planes askew between a narrow strip of floor and the wall, by 11 to 48 degrees, 0.16 to
  // 0.6.
  double max_below_per_inlier = 0.1;
  double smoothing = 0.25;  // weight of a new frame's plane in the reported one
  uint64_t seed = 1;
};

/// Options for a sensor under the ceiling that looks down by 52 degrees or more. By hand; sensors
/// are not higher than a room of 4 m.
FloorOptions FloorOptionsFromAbove();

/// State between frames.
struct FloorState {
  std::optional<FloorPlane> plane;
  int missed = 0;  // frames since the plane was last confirmed
};

/// The floor of this frame, or none if it is not seen with confidence. RANSAC with the prior
/// FloorOptions::up; the previous plane is tried first.
std::optional<FloorPlane> FindFloor(const PointGrid& grid, FloorState& state,
                                    const FloorOptions& options = {});

}  // namespace ossa::depth
