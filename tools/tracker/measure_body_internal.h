#pragma once
#include <array>
#include <optional>

#include "depth/scene/body_measures.h"
#include "depth/scene/floor.h"
#include "recon/skeleton.h"
#include "tools/tracker/perceive_internal.h"

namespace ossa::tracker {

/// What one look says of a body's measures: between joints that the forest is sure of.
depth::MeasuredBody MeasureBody(const Perception& perception,
                                const std::array<int, recon::kJointCount>& targets,
                                const std::optional<depth::FloorPlane>& floor);

}  // namespace ossa::tracker
