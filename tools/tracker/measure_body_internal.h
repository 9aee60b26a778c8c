#pragma once
#include <array>
#include <optional>

#include "depth/scene/body_measures.h"
#include "depth/scene/floor.h"
#include "depth/scene/scene.h"
#include "recon/skeleton.h"
#include "tools/tracker/perceive_internal.h"

namespace ossa::tracker {

/// What one look says of a body's measures: between joints that the forest is sure of.
depth::MeasuredBody MeasureBody(const Perception& perception, const recon::JointArray<int>& targets,
                                const std::optional<depth::FloorPlane>& floor);

/// The joints that the forest is sure of, in their order, as marks on the body.
depth::Marks SureJoints(const Perception& perception, const recon::JointArray<int>& targets);

}  // namespace ossa::tracker
