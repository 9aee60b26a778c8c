#pragma once
#include <Eigen/Core>
#include <array>

#include "depth/base/perceptron/quantised_perceptron.h"
#include "recon/posture.h"
#include "recon/refine/refinement_cascade.h"

namespace ossa::recon {

// Estimates a person's bone lengths with a network, from the joints of the refinement cascade in
// one frame. The distance between two estimated joints differs from the bone length, the more the
// less is visible. These errors depend on the pose, and bone lengths are correlated; both are
// learned from rendered people of many shapes.

/// The joints in which estimated bones end: of a pair the left one stands for both.
inline constexpr std::array<Joint, 11> kEstimatedBones = {
    Joint::kSpine,     Joint::kShoulderCenter, Joint::kHead,     Joint::kShoulderLeft,
    Joint::kElbowLeft, Joint::kWristLeft,      Joint::kHandLeft, Joint::kHipLeft,
    Joint::kKneeLeft,  Joint::kAnkleLeft,      Joint::kFootLeft};

/// Network inputs: all joints relative to the middle; the logarithm of each bone's measured length;
/// confidence and visibility of the joints; ProposedPerson::where_m.
inline constexpr int kBoneFeatures = 3 * kJointCount + (kJointCount - 1) + 2 * kJointCount + 3;
Eigen::RowVectorXf ComputeBoneFeatures(const ProposedPerson& person);

/// Network outputs: the logarithm of each estimated bone's length relative to the standard one, in
/// units of kBoneStep.
inline constexpr double kBoneStep = 0.1;
Eigen::RowVectorXf EncodeBoneLengths(const BoneLengths& lengths_m);

/// The mean of the network's estimates for the person and its mirror image.
BoneLengths EstimateBones(const QuantisedPerceptron& network, const ProposedPerson& person);

/// Inputs of the networks of a bone-conditioned stage: those of other stages, then
/// EncodeBoneLengths of the person's bones.
inline constexpr int kBoneConditionedFeatures =
    kStageFeatures + static_cast<int>(kEstimatedBones.size());

}  // namespace ossa::recon
