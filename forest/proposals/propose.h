#pragma once
#include <Eigen/Core>
#include <vector>

#include "depth/image/depth_frame.h"
#include "forest/classification/classify.h"

namespace ossa::forest {

/// A proposed 3D position of a target.
struct Proposal {
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();  // camera space, inside the body
  double confidence = 0.0;                               // [0, 1]
  bool seen = true;  // false: no surface of its own voted; inferred from other targets
};

/// Proposals for every target of the model (index = target), each list best first. If the model has
/// pose priors a target without evidence of its own is inferred from the others and not `seen`;
/// otherwise its list is empty. All lists are empty for an object without evidence.
/// Shotton et al. 2011, sec. 3.3.
std::vector<std::vector<Proposal>> Propose(const ForestModel& model, const depth::DepthView& depth,
                                           const depth::Camera& camera,
                                           const Classification& classification);

}  // namespace ossa::forest
