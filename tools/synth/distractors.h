#pragma once
#include <Eigen/Geometry>
#include <vector>

#include "depth/base/random.h"
#include "tools/synth/props.h"

namespace ossa::tools {

/// What stands about in homes and offices and is nobody, though it is as large as a person or
/// shaped like a part of one: shelves with things in them, coats on hooks, door frames, plants.
/// Background, in camera space; two to five of them around the person's place at the origin, never
/// on it.
std::vector<Prop> SampleDistractors(const Eigen::Isometry3d& camera_from_world, Random& random);

}  // namespace ossa::tools
