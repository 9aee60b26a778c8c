#pragma once
#include <optional>

#include "tools/people/body_measures.h"
#include "tools/people/forest_evidence.h"
#include "tools/people/track.h"

namespace ossa::people {

/// Measures of a body in one frame: between joints that the forest is sure of.
FrameMeasures MeasureBody(const ForestEvidence& evidence, const JointTargets& targets,
                          const std::optional<FloorPlane>& floor,
                          const MeasureOptions& options = {});

/// The joints that the forest is sure of, in their order.
Keypoints SelectKeypoints(const ForestEvidence& evidence, const JointTargets& targets,
                          const MeasureOptions& options = {});

}  // namespace ossa::people
