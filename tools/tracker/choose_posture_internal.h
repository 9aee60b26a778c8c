#pragma once
#include <Eigen/Core>
#include <array>
#include <optional>
#include <span>
#include <vector>

#include "depth/image/camera.h"
#include "forest/forest.h"
#include "forest/proposals/propose.h"
#include "recon/posture.h"
#include "tools/people/joint_targets.h"

namespace ossa::tracker {

/// How modes are chosen together. Costs are negative log-likelihoods (nats, no unit), >= 0.
/// Constants: chosen by hand on rendered clips of validation subjects, where nothing else is said.
struct ChoiceOptions {
  size_t modes = 4;           // modes beyond the fourth were never the right one on rendered frames
  double missing_cost = 2.3;  // logarithm, -log 0.1: a mode must be more likely
  double worst_bone = 6.0;    // a logarithm: a bone of any length may be a wrong expectation
  // Modes lie a few centimetres off, which short bones (hands, neck) feel most: the standard
  // deviation of a length is so much, and such a share of the expected one.
  double bone_m = 0.04, bone_share = 0.2;
  double worst_jump = 1.0;        // cost: fast moves and unrelated frames are legal
  double jump_m = 0.15;           // standard deviation: 4.5 m/s at 30 Hz
  double one_place_m = 0.045;     // anthropometry: clasped hands have centres 6 cm apart and more
  double thigh_m2 = 0.04;         // anthropometry: 12 cm x 35 cm
  double learning_frames = 30.0;  // > 0; a length is learned by one part in so many of each frame:
                                  // a second of frames decides
  double shortest = 0.5, longest = 1.5;  // anthropometry: of an average adult's bone, no adult or
                                         // child is outside
};

/// Whether this place of camera space (metres) projects into the image.
bool IsInImage(const depth::Camera& camera, const Eigen::Vector3d& place_m);

struct ChoiceContext {
  ChoiceOptions options;
  const depth::Camera* camera = nullptr;
  recon::BoneLengths expected_m{};                // of this person
  double leg_area_m2 = 1.0;                       // of surface that looks like legs
  const recon::TrackedPosture* before = nullptr;  // chosen in the last frame, if it is recent
};

/// The tracked posture that the proposals speak for: one mode per joint, chosen together so that
/// bones have the person's lengths and nothing jumps; states from the model's thresholds.
recon::TrackedPosture ChoosePosture(const forest::ForestModel& model,
                                    const people::JointTargets& targets,
                                    const std::vector<std::vector<forest::Proposal>>& proposals,
                                    const ChoiceContext& context);

/// What was seen, but is said to be elsewhere, so far away or outside of the image, is inferred.
void InferElsewhere(const recon::Posture& said_m, const depth::Camera& camera, double elsewhere_m,
                    recon::TrackedPosture& seen);

/// Bone lengths of an average adult, and how a person's own are learned: slowly, from bones whose
/// two ends are tracked.
recon::BoneLengths AverageBoneLengths();
void LearnBoneLengths(const recon::TrackedPosture& observed, recon::BoneLengths& lengths_m,
                      const ChoiceOptions& options = {});

}  // namespace ossa::tracker
