#pragma once
#include <Eigen/Core>

#include "depth/base/perceptron/perceptron.h"
#include "recon/normalise.h"
#include "recon/posture.h"

namespace ossa::recon {

/// 57 numbers: x y z of each bone's vector from parent to joint, joints 1 to 19 in enum order,
/// metres, of a normalised posture of the standard size.
inline constexpr int kBoneDims = 3 * (kJointCount - 1);
/// A posture as 57 numbers, metres: x y z of each bone, in the order of the joints they end in.
using BoneVector = Eigen::Matrix<double, kBoneDims, 1>;

/// What a PriorNetwork reads of a step of a PriorFilter, joints 1 to 19 in enum order, the standard
/// body: the bones that are expected (57), how clearly each joint is seen (0 not at all, 1 exactly;
/// 19), and how far from where it is expected it is seen (metres, 0 of joints that are not; 57).
inline constexpr int kPriorInputs = 2 * kBoneDims + kJointCount - 1;
/// What the prior's network reads.
using PriorInput = Eigen::Matrix<float, kPriorInputs, 1>;

/// How clearly a joint is seen whose place is known with that standard deviation; 0: not seen.
float ObservationQuality(double sd_m);

/// What a Gaussian prior cannot say of how people hold themselves: knees bend one way only, and who
/// bends down holds the hands otherwise than who squats. A network that knows how far the bones lie
/// from where a PriorFilter expects them: kPriorInputs -> kBoneDims, in kBoneStep_m. No size of its
/// own: it is learned for one PosturePrior, which it is part of.
struct PriorNetwork : Perceptron {
  static constexpr double kBoneStep_m = 0.1;  // a unit of the network's outputs, by hand

  /// To be added to the bones that were expected.
  BoneVector Correction_m(const PriorInput& input) const {
    return kBoneStep_m * Run(input.transpose()).row(0).transpose().cast<double>();
  }
};

}  // namespace ossa::recon
