#pragma once
#include <Eigen/Core>
#include <array>
#include <optional>
#include <span>
#include <vector>

#include "depth/image/camera.h"
#include "depth/image/depth_frame.h"
#include "forest/forest.h"
#include "forest/proposals/propose.h"
#include "recon/posture.h"
#include "tools/people/joint_targets.h"

namespace ossa::tracker {

/// Options of the joint choice of modes. Costs are negative log-likelihoods (nats, no unit), >= 0.
/// Constants: chosen by hand on rendered clips of validation subjects unless stated otherwise.
struct ChoiceOptions {
  size_t modes = 4;           // the fifth mode and later ones were never right on rendered frames
  double missing_cost = 2.3;  // logarithm, -log 0.1: modes with a lower likelihood are not chosen
  double worst_bone = 6.0;    // a logarithm, bounded because the expected length may be wrong
  // Standard deviation of a bone's length: a constant, because modes are off by a few centimetres,
  // which matters most for short bones (hands, neck), and a share of the expected length.
  double bone_m = 0.04, bone_share = 0.2;
  double worst_jump = 1.0;        // cost, bounded because of fast movements and cuts
  double jump_m = 0.15;           // standard deviation: 4.5 m/s at 30 Hz
  double one_place_m = 0.045;     // anthropometry: clasped hands have centres 6 cm apart and more
  double thigh_m2 = 0.04;         // anthropometry: 12 cm x 35 cm
  double learning_frames = 30.0;  // > 0; inverse weight of a frame in a length's mean: one second
  double shortest = 0.5, longest = 1.5;  // anthropometry: bounds of adults and children, as factors
                                         // of an average adult's bone
};

/// Whether a point of camera space (metres) projects into the image.
bool IsInImage(const depth::Camera& camera, const Eigen::Vector3d& place_m);

struct ChoiceContext {
  ChoiceOptions options;
  const depth::Camera* camera = nullptr;
  recon::BoneLengths expected_m{};                // of this person
  double leg_area_m2 = 1.0;                       // of surface classified as legs
  const recon::TrackedPosture* before = nullptr;  // of the last frame, if it is recent
};

/// Chooses one mode per joint so that together bone lengths match the person and joints do not
/// jump; the states follow the model's thresholds.
recon::TrackedPosture ChoosePosture(const forest::ForestModel& model,
                                    const people::JointTargets& targets,
                                    const std::vector<std::vector<forest::Proposal>>& proposals,
                                    const ChoiceContext& context);

/// Marks tracked joints as inferred where `said_m` has them farther than `elsewhere_m` away or
/// outside the image.
void InferElsewhere(const recon::Posture& said_m, const depth::Camera& camera, double elsewhere_m,
                    recon::TrackedPosture& seen);

/// Marks tracked joints as inferred where `said_m` has them in free space (recon::IsInFreeSpace):
/// no surface of the body is there, so the forest took another part for the joint.
void InferSeenThrough(const recon::Posture& said_m, const depth::DepthFrame& frame,
                      recon::TrackedPosture& seen);

/// Bone lengths of an average adult; slow update of a person's lengths from bones with two tracked
/// ends.
recon::BoneLengths AverageBoneLengths();
void LearnBoneLengths(const recon::TrackedPosture& observed, recon::BoneLengths& lengths_m,
                      const ChoiceOptions& options = {});

}  // namespace ossa::tracker
