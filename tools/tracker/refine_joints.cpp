#include "tools/tracker/refine_joints_internal.h"

namespace ossa::tracker {
namespace {

// The proposal that a joint was placed at, or the most confident one; null if there are none.
const forest::Proposal* ProposalAt(const std::vector<forest::Proposal>& best_first,
                                   const Eigen::Vector3d& place_m) {
  for (const forest::Proposal& proposal : best_first) {
    if (proposal.position_m == place_m) return &proposal;
  }
  return best_first.empty() ? nullptr : &best_first.front();
}

}  // namespace

std::optional<recon::RefinedPerson> RefineJoints(std::span<const uint8_t> is_person,
                                                 SkeletonWork& work) {
  const auto& proposals = work.detection->evidence.proposals;
  recon::BoneLengthEstimator& bones = work.person.bones;
  recon::RefinementInput input;
  if (bones.measurements(recon::Index(recon::Joint::kSpine)) > 0) input.bones_m = bones.lengths_m();
  for (size_t j = 0; j < recon::kJointCount; ++j) {
    const forest::Proposal* proposal =
        ProposalAt(proposals[static_cast<size_t>(work.options.targets[j])],
                   work.body.raw.posture.position_m[j]);
    if (proposal == nullptr) return std::nullopt;
    input.proposed.position_m[j] = proposal->position_m;
    input.confidence[j] = proposal->confidence;
    input.seen[j] = proposal->seen;
  }
  input.depth = &work.frame;
  input.is_person = is_person;
  input.floor = work.floor;
  auto refined = work.options.refinement->Refine(input);
  if (refined && refined->bones_m) bones.Add(*refined->bones_m);
  return refined;
}

}  // namespace ossa::tracker
