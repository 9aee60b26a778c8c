#pragma once
#include <Eigen/Core>
#include <vector>

#include "depth/image/depth_frame.h"
#include "forest/classification/classify.h"

namespace ossa::forest {

/// A 3D place where a target of the model may be.
struct Proposal {
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();  // camera space, inside the body
  double confidence = 0.0;                               // [0, 1]
  bool seen = true;  // false: no surface of its own voted; inferred from other parts
};

/// Proposals for every target of the model (index = target), each list best first. With
/// pose priors in the model a target without evidence of its own is proposed where the others say,
/// not `seen`; without them its list is empty, as all lists are of an object without evidence.
/// Shotton et al. 2011, sec. 3.3.
std::vector<std::vector<Proposal>> Propose(const ForestModel& model, const depth::DepthView& depth,
                                           const depth::Camera& camera,
                                           const Classification& classification);

}  // namespace ossa::forest
