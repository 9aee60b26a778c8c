#pragma once
#include <Eigen/Core>
#include <span>
#include <vector>

#include "depth/image/camera.h"
#include "forest/dense_internal.h"
#include "forest/forest.h"
#include "forest/proposals/modes_internal.h"
#include "forest/proposals/pose_inference_internal.h"

namespace ossa::forest {

/// What the refinement knows of an object, and where it knows it from.
struct Description {
  Eigen::Vector3d root_m = Eigen::Vector3d::Zero();                 // amid the places
  Eigen::Matrix3d frame_from_camera = Eigen::Matrix3d::Identity();  // z along the ray to the root
  std::vector<Eigen::Vector3d> place_m;  // of each target, camera axes: modes and prediction fused
  std::vector<float> value;              // DescriptionSize numbers
};

/// All that earlier stages found of one object, as numbers in a frame that stands in it.
Description Describe(const ForestModel& model, const depth::Camera& camera,
                     const Evidence& evidence, std::span<const float> context_posterior,
                     const ModesOfTargets& modes, const Beliefs& beliefs);

/// Rows of outputs for rows of normalised inputs: per target an offset in steps of
/// kRefinementStep_m, then for all targets the logit of the confidence.
RowMatrix RunLayers(const Refinement& refinement, RowMatrix rows);
inline constexpr double kRefinementStep_m = 0.1;

/// A description as the layers want it: about its mean, in standard deviations, outliers cut off.
RowMatrix Normalised(const Refinement& refinement, std::span<const float> description);

/// The places as the refinement says, one a target. Precondition: it has layers.
std::vector<RefinedPlace> Refine(const Refinement& refinement, const Description& description);

}  // namespace ossa::forest
