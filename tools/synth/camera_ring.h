#pragma once
#include <Eigen/Geometry>
#include <cstdint>
#include <span>
#include <vector>

namespace ossa::tools {

/// Several cameras around the same people: where each looks from. Entry k takes points of the world
/// (y up, floor at y = 0, the first person over the origin) to camera k's space; entry 0 is
/// `camera_from_world`. The others are camera 0 turned about the world's vertical by even steps up
/// to an arc of 60 to 120 degrees, drawn by the seed, towards the side that the first person faces
/// (`facing_rad`, positive to the person's left); one that would stand closer to somebody at
/// `places_m` than a metre and a half, or than camera 0 does, stands farther back.
std::vector<Eigen::Isometry3d> PlaceCameras(const Eigen::Isometry3d& camera_from_world,
                                            std::span<const Eigen::Vector3d> places_m,
                                            double facing_rad, int cameras, uint64_t seed);

}  // namespace ossa::tools
