// Shotton et al. 2011, sec. 3.3 (weighted mean shift on classified surface, eqs. 7-8) combined with
// the position votes of Girshick et al. 2011: a target's density is
//   D(x) = class_weight · Σ_i P(c|i) · area_i · K(x - s_i) / A0  +  Σ_j w_j · K(x - v_j) / Σ_j w_j
// for pushed-back surface points s_i and votes v_j. Classified surface locates visible joints,
// votes also hidden ones.
#include "forest/proposals/propose.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "forest/proposals/modes_internal.h"
#include "forest/proposals/pose_inference_internal.h"
#include "forest/proposals/refinement_internal.h"

namespace ossa::forest {
namespace {

// Constants: chosen by hand, for speed.

constexpr size_t kStarts = 12;
constexpr size_t kClimbs = 3;
constexpr int kMaxSteps = 20;
constexpr float kStopStep_m = 2e-3F;  // convergence within a centimetre

std::vector<Eigen::Vector3f> StartPoints(const WeightedPoints& points, float bandwidth_m) {
  std::vector<std::pair<float, size_t>> by_density;
  const size_t step = std::max<size_t>(1, points.size() / kStarts);
  for (size_t i = 0; i < points.size(); i += step) {
    by_density.emplace_back(-Density(points, points.at(i), 1.5F * bandwidth_m), i);
  }
  const auto weights = std::span(points.weight).first(points.size());
  const auto heaviest =
      static_cast<size_t>(std::max_element(weights.begin(), weights.end()) - weights.begin());
  by_density.emplace_back(-Density(points, points.at(heaviest), 1.5F * bandwidth_m), heaviest);
  std::sort(by_density.begin(), by_density.end());
  std::vector<Eigen::Vector3f> starts;
  for (const auto& [density, i] : by_density) {
    const Eigen::Vector3f p = points.at(i);
    const bool is_new = std::all_of(starts.begin(), starts.end(), [&](const auto& s) {
      return (s - p).norm() > 2.0F * bandwidth_m;
    });
    if (is_new) starts.push_back(p);
    if (starts.size() == kClimbs) break;
  }
  return starts;
}

Mode Climb(const WeightedPoints& points, Eigen::Vector3f at_m, float bandwidth_m) {
  Mode mode;
  for (int step = 0; step < kMaxSteps; ++step) {
    const KernelSum sum = SumKernels(points, at_m, bandwidth_m);
    mode.position_m = at_m;
    mode.density = sum.density;
    if (!(sum.density > 1e-12F)) break;
    const Eigen::Vector3f next = sum.moment / sum.density;
    const bool converged = (next - at_m).norm() < kStopStep_m;
    at_m = next;
    if (converged) break;
  }
  return mode;
}

void KeepDistinct(std::vector<Mode>* modes, float bandwidth_m) {
  std::sort(modes->begin(), modes->end(),
            [](const Mode& a, const Mode& b) { return a.density > b.density; });
  std::vector<Mode> kept;
  for (const Mode& mode : *modes) {
    const bool is_new = std::all_of(kept.begin(), kept.end(), [&](const Mode& other) {
      return (other.position_m - mode.position_m).norm() > bandwidth_m;
    });
    if (is_new && mode.density > 0.05F * modes->front().density) kept.push_back(mode);
  }
  *modes = std::move(kept);
}

// Double precision: every math library rounds it alike.
float Log1p(float x) { return static_cast<float>(std::log1p(static_cast<double>(x))); }

void DescribeModes(const Evidence& evidence, const TargetPoints& points,
                   const ProposalTarget& target, std::vector<Mode>* modes) {
  float total = 0.0F;
  for (const Mode& mode : *modes) total += mode.density;
  for (Mode& mode : *modes) {
    const float bandwidth_m = std::max(target.bandwidth_m, 0.06F);
    const float surface = Density(points.surface, mode.position_m, bandwidth_m);
    const float votes =
        Density(points.points, mode.position_m, bandwidth_m) - target.class_weight * surface;
    mode.feature = {Log1p(10.0F * surface), std::sqrt(std::max(votes, 0.0F)), mode.density / total,
                    Log1p(points.vote_total * 1e3F), evidence.context_certainty};
  }
}

Proposal ProposalAt(const ProposalTarget& target, const Mode& mode) {
  Proposal proposal;
  proposal.position_m = mode.position_m.cast<double>();
  proposal.confidence = Evaluate(target.correct, mode.feature);
  proposal.seen = Evaluate(target.visible, mode.feature) >= 0.5;
  return proposal;
}

std::vector<std::vector<Proposal>> ProposeSingly(const ForestModel& model,
                                                 const TargetModes& modes) {
  std::vector<std::vector<Proposal>> proposals(modes.size());
  for (size_t t = 0; t < modes.size(); ++t) {
    for (const Mode& mode : modes[t]) {
      proposals[t].push_back(ProposalAt(model.targets()[t], mode));
    }
  }
  return proposals;
}

// Proposes fused positions and separate modes.
std::vector<std::vector<Proposal>> ProposeTogether(const ForestModel& model,
                                                   const PoseMarginals& marginals,
                                                   const TargetModes& modes,
                                                   const std::vector<RefinedPlace>& refined) {
  std::vector<std::vector<Proposal>> proposals(modes.size());
  for (size_t t = 0; t < modes.size(); ++t) {
    const ProposalTarget& target = model.targets()[t];
    const RefinedPlace* place = refined.empty() ? nullptr : &refined[t];
    for (const PlaceCandidate& candidate : Candidates(target, marginals, t, modes[t], place)) {
      Proposal proposal;
      if (candidate.mode >= 0) {
        proposal = ProposalAt(target, modes[t][static_cast<size_t>(candidate.mode)]);
      } else {
        proposal.seen = false;  // inferred from the other targets only
      }
      proposal.position_m = candidate.position_m;
      proposal.confidence = ComputeConfidence(target, candidate);
      proposals[t].push_back(proposal);
    }
    std::stable_sort(
        proposals[t].begin(), proposals[t].end(),
        [](const Proposal& a, const Proposal& b) { return a.confidence > b.confidence; });
  }
  return proposals;
}

}  // namespace

std::vector<Mode> FindModes(const Evidence& evidence, const ProposalTarget& target,
                            size_t target_index) {
  const TargetPoints points = GatherPoints(evidence, target, target_index);
  if (points.points.size() == 0) return {};
  std::vector<Mode> modes;
  for (const Eigen::Vector3f& start : StartPoints(points.points, target.bandwidth_m)) {
    modes.push_back(Climb(points.points, start, target.bandwidth_m));
  }
  KeepDistinct(&modes, target.bandwidth_m);
  DescribeModes(evidence, points, target, &modes);
  return modes;
}

std::vector<std::vector<Proposal>> Propose(const ForestModel& model, const depth::DepthView& depth,
                                           const depth::Camera& camera,
                                           const Classification& classification) {
  const Evidence evidence = GatherEvidence(model, depth, camera, classification);
  TargetModes modes;
  for (size_t t = 0; t < model.targets().size(); ++t) {
    modes.push_back(FindModes(evidence, model.targets()[t], t));
  }
  const bool is_blank = std::all_of(modes.begin(), modes.end(),
                                    [](const std::vector<Mode>& list) { return list.empty(); });
  if (is_blank || model.data().pose_priors.empty()) return ProposeSingly(model, modes);
  const PoseMarginals marginals = InferPose(model, classification.context, modes);
  std::vector<RefinedPlace> refined;
  if (!model.refinement().empty()) {
    refined = Refine(
        model.refinement(),
        ComputeJointFeatures(model, camera, evidence, classification.context, modes, marginals));
  }
  return ProposeTogether(model, marginals, modes, refined);
}

}  // namespace ossa::forest
