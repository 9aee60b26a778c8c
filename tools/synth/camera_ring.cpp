#include "tools/synth/camera_ring.h"

#include <algorithm>
#include <limits>

#include "depth/base/angles.h"
#include "depth/base/random.h"

namespace ossa::tools {
namespace {

double LeastDistance_m(const Eigen::Vector3d& camera_m, std::span<const Eigen::Vector3d> places_m) {
  double least_m = std::numeric_limits<double>::infinity();
  for (const Eigen::Vector3d& place_m : places_m) {
    const Eigen::Vector3d apart_m = camera_m - place_m;
    least_m = std::min(least_m, std::hypot(apart_m.x(), apart_m.z()));
  }
  return least_m;
}

Eigen::Isometry3d StepBack(Eigen::Isometry3d world_from_camera,
                           std::span<const Eigen::Vector3d> places_m, double least_m) {
  constexpr double kStep_m = 0.1;  // by hand
  constexpr int kMostSteps = 40;   // a bound: people are within two metres of the origin
  Eigen::Vector3d outwards = world_from_camera.translation();
  outwards.y() = 0.0;
  if (!(outwards.norm() > 0.0)) return world_from_camera;
  for (int i = 0; i < kMostSteps; ++i) {
    if (LeastDistance_m(world_from_camera.translation(), places_m) >= least_m) break;
    world_from_camera.translation() += kStep_m * outwards.normalized();
  }
  return world_from_camera;
}

}  // namespace

std::vector<Eigen::Isometry3d> PlaceCameras(const Eigen::Isometry3d& camera_from_world,
                                            std::span<const Eigen::Vector3d> places_m,
                                            double facing_rad, int cameras, uint64_t seed) {
  constexpr double kLeastArc_deg = 60.0, kMostArc_deg = 120.0;  // by hand: the views overlap
  constexpr double kLeast_m = 1.5;     // by hand: nearer, less of a body is in view
  constexpr uint64_t kArcStream = 78;  // by hand: unused by other draws
  const double side = facing_rad < 0.0 ? -1.0 : 1.0;
  const double arc_deg = Random(seed, kArcStream).Uniform(kLeastArc_deg, kMostArc_deg);
  const Eigen::Isometry3d world_from_camera_0 = camera_from_world.inverse();
  const double least_m =
      std::min(kLeast_m, LeastDistance_m(world_from_camera_0.translation(), places_m));
  std::vector<Eigen::Isometry3d> all{camera_from_world};
  for (int k = 1; k < cameras; ++k) {
    const double azimuth_rad = side * arc_deg * kDegree * k / (cameras - 1);
    const Eigen::Isometry3d turned =
        Eigen::AngleAxisd(azimuth_rad, Eigen::Vector3d::UnitY()) * world_from_camera_0;
    all.push_back(StepBack(turned, places_m, least_m).inverse());
  }
  return all;
}

}  // namespace ossa::tools
