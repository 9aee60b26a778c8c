#pragma once
#include <vector>

#include "depth/scene/point_grid.h"
#include "tests/support/capsule_person.h"

namespace ossa::depth {

using tests::CapsulePose;
using tests::CapsuleRender;
using tests::CapsuleScene;

inline CapsulePose PersonAt(double x_m, double z_m) {
  CapsulePose pose;
  pose.feet_m = {x_m, -1.0, z_m};
  pose.left_lift_rad = pose.right_lift_rad = 0.5;
  return pose;
}

inline CapsuleRender Shot(const std::vector<CapsulePose>& people, int frame = 0,
                          const std::vector<tests::Box>& boxes = {}) {
  CapsuleScene scene;
  scene.people = people;
  scene.boxes = boxes;
  scene.planes = tests::EmptyRoom();
  CapsuleRender render = tests::Render(scene, KinectV1Camera(320, 240));
  render.frame.index = frame;
  render.frame.time_s = frame / 30.0;
  return render;
}

inline PointGrid GridOf(const CapsuleRender& render) {
  return MakePointGrid(render.frame.view(), render.frame.camera, 6.0F);
}

}  // namespace ossa::depth
