#pragma once
#include <array>
#include <optional>
#include <vector>

#include "depth/scene/scene.h"
#include "forest/proposals/propose.h"
#include "recon/refine/bone_measure.h"
#include "recon/refine/close_look.h"

namespace ossa::tracker {

/// The joints of a posture chosen among the proposals, looked at again; those for which nothing was
/// chosen from where they are likeliest. Nothing where some joint has no proposal at all. `bones`:
/// the person's as judged until now, of which the look is told; this frame's are added.
std::optional<recon::Looked> LookClosely(
    const recon::Looker& look, const depth::DepthFrame& frame, const depth::Candidate& candidate,
    const std::vector<std::vector<forest::Proposal>>& proposals,
    const recon::JointArray<int>& targets, const recon::TrackedPosture& chosen,
    recon::JudgedBones* bones);

}  // namespace ossa::tracker
