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

/// Inputs of a PriorNetwork in a step of a PriorFilter, joints 1 to 19 in enum order, on the
/// standard body: the predicted bones (57, metres), the quality of each joint's observation (19; 0:
/// not seen, 1: exact), and its offset from the prediction (57, metres; 0 for unseen joints).
inline constexpr int kPriorInputs = 2 * kBoneDims + kJointCount - 1;
/// The inputs of a PriorNetwork.
using PriorInput = Eigen::Matrix<float, kPriorInputs, 1>;

/// Quality, [0, 1], of an observation with this standard deviation, metres; 0: not seen.
float ObservationQuality(double sd_m);

/// Non-Gaussian part of a pose prior: knees bend one way only, and hands hang differently when
/// bending down than when squatting. A network that estimates the offset of the bones from a
/// PriorFilter's prediction: kPriorInputs -> kBoneDims, in units of kBoneStep_m. It is trained for
/// the PosturePrior of which it is a part.
struct PriorNetwork : Perceptron {
  static constexpr double kBoneStep_m = 0.1;  // a unit of the network's outputs, by hand

  /// Correction of the predicted bones, metres, to be added.
  BoneVector Correction_m(const PriorInput& input) const {
    return kBoneStep_m * Run(input.transpose()).row(0).transpose().cast<double>();
  }
};

}  // namespace ossa::recon
