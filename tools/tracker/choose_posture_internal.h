#pragma once
#include <Eigen/Core>
#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "depth/image/camera.h"
#include "depth/scene/point_grid.h"
#include "forest/forest.h"
#include "forest/proposals/propose.h"
#include "recon/posture.h"

namespace ossa::tracker {

/// Which target of the model is which joint; throws InputError when the model lacks one.
recon::JointArray<int> JointTargets(const forest::ForestModel& model,
                                    const std::string& model_name);

struct ChoiceContext {
  const depth::Camera* camera = nullptr;
  recon::BoneLengths expected_m{};                // of this person
  double leg_area_m2 = 1.0;                       // of surface that looks like legs
  const recon::TrackedPosture* before = nullptr;  // chosen in the last frame, if it is recent
};

/// The tracked posture that the proposals speak for: one mode per joint, chosen together so that
/// bones have the person's lengths and nothing jumps; states from the model's thresholds.
recon::TrackedPosture ChoosePosture(const forest::ForestModel& model,
                                    const recon::JointArray<int>& targets,
                                    const std::vector<std::vector<forest::Proposal>>& proposals,
                                    const ChoiceContext& context);

/// Bone lengths of an average adult, and how a person's own are learned: slowly, from bones whose
/// two ends are tracked.
recon::BoneLengths AverageBoneLengths();
void LearnBoneLengths(const recon::TrackedPosture& observed, recon::BoneLengths& lengths_m);

}  // namespace ossa::tracker
