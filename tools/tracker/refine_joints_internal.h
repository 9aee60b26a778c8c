#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "depth/image/depth_frame.h"
#include "recon/refine/refinement_cascade.h"
#include "tools/people/candidate.h"
#include "tools/tracker/skeleton_stages_internal.h"

namespace ossa::tracker {

/// Of each of the frame's pixels, row-major: 1 for this person's.
std::vector<uint8_t> MaskOf(const people::Candidate& candidate, const depth::DepthFrame& frame);

/// The joints of a posture chosen among the proposals, refined at the depth image; those for which
/// nothing was chosen from where they are likeliest. Nothing where some joint has no proposal at
/// all. `is_person`: MaskOf. The cascade reads the person's bones as estimated until now; this
/// frame's are added. Precondition: there is a refinement.
std::optional<recon::RefinedPerson> RefineJoints(std::span<const uint8_t> is_person,
                                                 SkeletonWork& work);

}  // namespace ossa::tracker
