#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "forest/proposals/propose.h"
#include "recon/refine/bone_estimation.h"
#include "recon/refine/pose_network.h"
#include "recon/refine/refinement_cascade.h"
#include "tools/people/candidate.h"
#include "tools/people/joint_targets.h"

namespace ossa::tracker {

/// Of each of the frame's pixels, row-major: 1 for this person's.
std::vector<uint8_t> MaskOf(const people::Candidate& candidate, const depth::DepthFrame& frame);

/// The joints of a posture chosen among the proposals, refined at the depth image; those for which
/// nothing was chosen from where they are likeliest. Nothing where some joint has no proposal at
/// all. `is_person`: MaskOf. `bones`: the person's as estimated until now, which the cascade reads;
/// this frame's are added.
std::optional<recon::RefinedPerson> RefineJoints(
    const recon::JointRefiner& refiner, const depth::DepthFrame& frame,
    std::span<const uint8_t> is_person, const std::vector<std::vector<forest::Proposal>>& proposals,
    const people::JointTargets& targets, const recon::TrackedPosture& chosen,
    recon::MeanBoneLengths* bones);

}  // namespace ossa::tracker
