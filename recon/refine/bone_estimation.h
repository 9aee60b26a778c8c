#pragma once
#include <Eigen/Core>
#include <array>

#include "depth/base/perceptron/quantised_perceptron.h"
#include "recon/posture.h"
#include "recon/refine/refinement_cascade.h"

namespace ossa::recon {

/// How long a person's bones are, estimated by a network from where the refinement cascade puts the
/// joints in one frame. What is measured between two joints is longer or shorter than the bone, the
/// more so the less of it is seen; how it errs in which pose, and which bones go with which, is
/// learned from rendered people of many shapes.

/// The joints in which estimated bones end: of a pair the left one stands for both.
inline constexpr std::array<Joint, 11> kEstimatedBones = {
    Joint::kSpine,     Joint::kShoulderCenter, Joint::kHead,     Joint::kShoulderLeft,
    Joint::kElbowLeft, Joint::kWristLeft,      Joint::kHandLeft, Joint::kHipLeft,
    Joint::kKneeLeft,  Joint::kAnkleLeft,      Joint::kFootLeft};

/// What the network reads: where all joints lie from the middle; of each bone the logarithm of its
/// length as it lies there; how confident joints are and which are seen; ProposedPerson::where_m.
inline constexpr int kBoneFeatures = 3 * kJointCount + (kJointCount - 1) + 2 * kJointCount + 3;
Eigen::RowVectorXf ComputeBoneFeatures(const ProposedPerson& person);

/// The network's outputs: of each estimated bone the logarithm of its length over the standard one,
/// in steps of kBoneStep.
inline constexpr double kBoneStep = 0.1;
Eigen::RowVectorXf EncodeBoneLengths(const BoneLengths& lengths_m);

/// The mean of the network's estimates for the person and for the mirror image.
BoneLengths EstimateBones(const QuantisedPerceptron& network, const ProposedPerson& person);

/// What the networks of a bone-conditioned stage read: what others read, then EncodeBoneLengths of
/// the person's bones.
inline constexpr int kBoneConditionedFeatures =
    kStageFeatures + static_cast<int>(kEstimatedBones.size());

}  // namespace ossa::recon
