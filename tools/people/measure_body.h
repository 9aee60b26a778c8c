#pragma once
#include <optional>

#include "tools/people/body_measures.h"
#include "tools/people/forest_evidence.h"
#include "tools/people/track.h"

namespace ossa::people {

/// The body measures of one frame, between joints with confident proposals.
FrameMeasures MeasureBody(const ForestEvidence& evidence, const JointTargets& targets,
                          const std::optional<FloorPlane>& floor,
                          const MeasureOptions& options = {});

/// The joints with confident proposals, in SDK order.
Keypoints SelectKeypoints(const ForestEvidence& evidence, const JointTargets& targets,
                          const MeasureOptions& options = {});

}  // namespace ossa::people
