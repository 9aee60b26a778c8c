#pragma once
#include <cstdint>
#include <optional>
#include <span>

#include "recon/refine/refinement_cascade.h"
#include "tools/tracker/skeleton_stages_internal.h"

namespace ossa::tracker {

/// Refines the chosen joints at the depth image; joints without a choice start from their most
/// confident proposal. Nothing if a joint has no proposal at all. `is_person`: people::MaskPixels
/// of the person. The cascade reads the person's bone lengths estimated so far, and this frame's
/// are added. Precondition: there is a refinement.
std::optional<recon::RefinedPerson> RefineJoints(std::span<const uint8_t> is_person,
                                                 SkeletonWork& work);

}  // namespace ossa::tracker
