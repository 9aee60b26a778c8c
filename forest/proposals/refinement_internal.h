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

/// What the refinement reads of an object, and the places that it moves.
struct JointFeatures {
  ViewFrame frame;                       // about the places' middle
  std::vector<Eigen::Vector3d> place_m;  // of each target, camera axes: modes and prediction fused
  Eigen::RowVectorXf value;              // JointFeatureCount numbers
};

/// All that earlier stages found of one object, as numbers in a frame that stands in it.
JointFeatures ComputeJointFeatures(const ForestModel& model, const depth::Camera& camera,
                                   const Evidence& evidence,
                                   std::span<const float> context_posterior,
                                   const TargetModes& modes, const PoseMarginals& marginals);

/// The places as the refinement moves them, one a target. Its outputs: per target an offset
/// (OffsetScale's default), then for all targets the logit of the confidence. Precondition: it has
/// layers.
std::vector<RefinedPlace> Refine(const RoundedPerceptron& refinement,
                                 const JointFeatures& features);

}  // namespace ossa::forest
