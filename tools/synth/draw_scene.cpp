#include <algorithm>

#include "tools/synth/camera_ring.h"
#include "tools/synth/draw_scene_internal.h"

namespace ossa::tools {
namespace {

// The first person is at the origin, the others around it without overlap.
std::vector<Eigen::Vector3d> SamplePlaces(int people, Random& random) {
  constexpr double kApart_m = 0.55;  // by hand
  std::vector<Eigen::Vector3d> places{Eigen::Vector3d::Zero()};
  while (static_cast<int>(places.size()) < people) {
    const double z_m = random.Uniform(-1.8, 0.5), x_m = random.Uniform(-1.6, 1.6);
    const Eigen::Vector3d place(x_m, 0, z_m);
    const bool free = std::all_of(places.begin(), places.end(), [&](const auto& other) {
      return (place - other).norm() > kApart_m;
    });
    if (free) places.push_back(place);
  }
  return places;
}

}  // namespace

PeopleScene DrawScene(const FrameOptions& options, double person_m, Random& random) {
  PeopleScene scene;
  scene.view = SampleView({.view = options.view,
                           .split = options.split,
                           .width = options.width,
                           .height = options.height,
                           .person_height_m = person_m,
                           .cameras = options.cameras,
                           .fov_deg = options.fov_deg,
                           .shrink = options.shrink},
                          random);
  scene.places_m = SamplePlaces(options.people, random);
  scene.cameras_from_world = PlaceCameras(scene.view.camera_from_world, scene.places_m,
                                          scene.view.facing_rad, options.views, options.seed);
  return scene;
}

}  // namespace ossa::tools
