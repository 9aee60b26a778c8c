#include "recon/refine/fuse_poses.h"

#include <algorithm>

namespace ossa::recon {
namespace {

// Weight of the network's position for a joint that both estimates place `apart_m` from each other,
// by their expected errors.
double ShareOfNetwork(double before_m, double network_m, double apart_m,
                      const FusionOptions& options) {
  if (apart_m > options.contradiction * (before_m + network_m)) {
    return network_m < before_m ? 1.0 : 0.0;
  }
  return before_m * before_m / (before_m * before_m + network_m * network_m);
}

}  // namespace

Posture FusePoses(const Posture& joints_m, const JointArray<double>& confidence,
                  const NetworkPose& network, const FusionOptions& options) {
  Posture fused_m = joints_m;
  for (size_t j = 0; j < kJointCount; ++j) {
    const double doubt = 1.0 - std::clamp(confidence[j], 0.0, 1.0);
    const double network_m = options.off_on_real_depth * network.error_m[j];
    const double before_m = std::max(options.sure_m + doubt * (options.unsure_m - options.sure_m),
                                     options.unseen_ratio * doubt * network_m);
    const Eigen::Vector3d apart_m = network.joints_m.position_m[j] - joints_m.position_m[j];
    const double share = ShareOfNetwork(before_m, network_m, apart_m.norm(), options);
    fused_m.position_m[j] += share * apart_m;
  }
  return fused_m;
}

}  // namespace ossa::recon
