#include "recon/gp/prior_network.h"

namespace ossa::recon {

float Clearness(double sd_m) {
  constexpr double kHalfClear_m = 0.1;
  return sd_m > 0.0 ? static_cast<float>(kHalfClear_m / (kHalfClear_m + sd_m)) : 0.0F;
}

BoneVector PriorNetwork::Correction_m(const PriorInput& input) const {
  // What was never seen while it was learned is taken for the most that was.
  constexpr float kFarthest = 5.0F;  // standard deviations
  const PriorInput normal =
      (input - input_mean).cwiseProduct(input_scale).cwiseMin(kFarthest).cwiseMax(-kFarthest);
  const Eigen::VectorXf unit = (unit_weight * normal + unit_bias).cwiseMax(0.0F);
  return kBoneStep_m * (bone_weight * unit + bone_bias).cast<double>();
}

}  // namespace ossa::recon
