#pragma once
#include <Eigen/Geometry>
#include <vector>

#include "depth/base/random.h"
#include "tools/synth/props.h"

namespace ossa::tools {

/// Objects of homes and offices that a detector may take for a person, as large as one or shaped
/// like a part of one: filled shelves, coats on hooks, door frames, plants. Two to five of them,
/// labelled as background, in camera space, around the person at the world's origin but not on it.
std::vector<Prop> SampleDistractors(const Eigen::Isometry3d& camera_from_world, Random& random);

}  // namespace ossa::tools
