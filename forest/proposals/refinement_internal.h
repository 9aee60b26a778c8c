#pragma once
#include <Eigen/Core>
#include <span>
#include <vector>

#include "depth/base/perceptron/pose_regression.h"
#include "depth/base/perceptron/rounded_perceptron.h"
#include "depth/image/camera.h"
#include "forest/forest.h"
#include "forest/proposals/modes_internal.h"
#include "forest/proposals/pose_inference_internal.h"

namespace ossa::forest {

/// The refinement's input for an object, and the positions that it moves.
struct JointFeatures {
  ViewFrame frame;                       // at the mean position
  std::vector<Eigen::Vector3d> place_m;  // per target, camera axes: modes and prediction fused
  Eigen::RowVectorXf value;              // JointFeatureCount numbers
};

/// Encodes the results of earlier stages in a frame centred on the object.
JointFeatures ComputeJointFeatures(const ForestModel& model, const depth::Camera& camera,
                                   const Evidence& evidence,
                                   std::span<const float> context_posterior,
                                   const TargetModes& modes, const PoseMarginals& marginals);

/// The refined positions, one per target. Network outputs: one offset per target (OffsetScale's
/// default), then the logits of all targets' confidences. Precondition: it has layers.
std::vector<RefinedPlace> Refine(const RoundedPerceptron& refinement,
                                 const JointFeatures& features);

}  // namespace ossa::forest
