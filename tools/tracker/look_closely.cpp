#include "tools/tracker/look_closely_internal.h"

namespace ossa::tracker {
namespace {

// The proposal that a joint was put on, or the likeliest one; null without any.
const forest::Proposal* ProposalAt(const std::vector<forest::Proposal>& best_first,
                                   const Eigen::Vector3d& place_m) {
  for (const forest::Proposal& proposal : best_first) {
    if (proposal.position_m == place_m) return &proposal;
  }
  return best_first.empty() ? nullptr : &best_first.front();
}

}  // namespace

std::optional<recon::Looked> LookClosely(
    const recon::Looker& look, const depth::DepthFrame& frame, const depth::Candidate& candidate,
    const std::vector<std::vector<forest::Proposal>>& proposals,
    const recon::JointArray<int>& targets, const recon::TrackedPosture& chosen,
    recon::JudgedBones* bones) {
  recon::LookInput input;
  if (bones->frames > 0) input.bones_m = bones->mean_m;
  for (size_t j = 0; j < recon::kJointCount; ++j) {
    const forest::Proposal* proposal =
        ProposalAt(proposals[static_cast<size_t>(targets[j])], chosen.posture.position_m[j]);
    if (proposal == nullptr) return std::nullopt;
    input.proposed.position_m[j] = proposal->position_m;
    input.confidence[j] = proposal->confidence;
    input.seen[j] = proposal->seen;
  }
  std::vector<uint8_t> is_person(frame.depth_mm.size(), 0);
  for (const int32_t pixel : candidate.pixels) is_person[static_cast<size_t>(pixel)] = 1;
  input.depth = &frame;
  input.is_person = is_person;
  auto looked = look.Look(input);
  if (looked && looked->bones_m) bones->Add(*looked->bones_m);
  return looked;
}

}  // namespace ossa::tracker
