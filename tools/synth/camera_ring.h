#pragma once
#include <Eigen/Geometry>
#include <cstdint>
#include <span>
#include <vector>

namespace ossa::tools {

/// Poses of `cameras` cameras around the same people. Entry k transforms world points (metres, y
/// up, floor at y = 0, the first person at the origin) to camera k's space; entry 0 is
/// `camera_from_world`. The other cameras are camera 0 rotated about the world's vertical in even
/// steps over an arc of 60 to 120 degrees, drawn from the seed, towards the side that the first
/// person faces (`facing_rad`, positive to the person's left). A camera that would be closer to a
/// person at `places_m` than 1.5 m, or than camera 0 is, moves farther back.
std::vector<Eigen::Isometry3d> PlaceCameras(const Eigen::Isometry3d& camera_from_world,
                                            std::span<const Eigen::Vector3d> places_m,
                                            double facing_rad, int cameras, uint64_t seed);

}  // namespace ossa::tools
