#pragma once
#include <Eigen/Core>
#include <array>

#include "recon/models/network_runner.h"
#include "recon/posture.h"
#include "recon/refine/close_look.h"

namespace ossa::recon {

/// How long a person's bones are, judged by a network from where a close look puts the joints in
/// one frame. What is measured between two joints is longer or shorter than the bone, the more so
/// the less of it is seen; how it errs in which pose, and which bones go with which, is learned of
/// rendered people of many shapes.

/// The joints in which measured bones end: of a pair the left one stands for both.
inline constexpr std::array<Joint, 11> kMeasuredBones = {
    Joint::kSpine,     Joint::kShoulderCenter, Joint::kHead,     Joint::kShoulderLeft,
    Joint::kElbowLeft, Joint::kWristLeft,      Joint::kHandLeft, Joint::kHipLeft,
    Joint::kKneeLeft,  Joint::kAnkleLeft,      Joint::kFootLeft};

/// What the network reads: where all joints lie from the middle; of each bone the logarithm of its
/// length as it lies there; how confident the joints are and which are seen; the middle.
inline constexpr int kBoneInputs = 3 * kJointCount + (kJointCount - 1) + 2 * kJointCount + 3;
Eigen::VectorXf BoneNumbersOf(const ProposedPerson& person);

/// What it says: of each measured bone the logarithm of its length over the standard one, in steps
/// of kBoneStep.
inline constexpr double kBoneStep = 0.1;
Eigen::VectorXf BoneOutputsOf(const BoneLengths& lengths_m);

/// The mean of what it says of the person and of the mirror image.
BoneLengths MeasuredBones(const NetworkRunner& network, const ProposedPerson& person);

/// Mean length of each bone over the frames in which it was judged.
struct JudgedBones {
  void Add(const BoneLengths& judged_m);
  BoneLengths mean_m{};
  int frames = 0;  // up to twenty seconds: what is older fades
};

/// What the networks of a glance read that is told the bones: what others read, and the bones as
/// the network above says them.
inline constexpr int kToldInputs = kLookInputs + static_cast<int>(kMeasuredBones.size());

}  // namespace ossa::recon
