#pragma once
#include <Eigen/Geometry>
#include <vector>

#include "depth/base/random.h"
#include "tools/synth/frame_maker.h"
#include "tools/synth/view_sampler.h"

namespace ossa::tools {

/// Places of people and cameras. World: metres, y up, floor at y = 0.
struct PeopleScene {
  ViewSample view;                                    // of camera 0
  std::vector<Eigen::Vector3d> places_m;              // of the people, the first at the origin
  std::vector<Eigen::Isometry3d> cameras_from_world;  // camera 0 first
};

/// `person_m`: height of the first person, metres.
PeopleScene DrawScene(const FrameOptions& options, double person_m, Random& random);

}  // namespace ossa::tools
