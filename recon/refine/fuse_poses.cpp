#include "recon/refine/fuse_poses.h"

#include <algorithm>

namespace ossa::recon {

Posture FusePoses(const Posture& joints_m, const JointArray<double>& confidence,
                  const NetworkPose& network, const FusionOptions& options) {
  const auto square = [](double m) { return m * m; };
  Posture fused_m = joints_m;
  for (size_t j = 0; j < kJointCount; ++j) {
    const double doubt = 1.0 - std::clamp(confidence[j], 0.0, 1.0);
    const double before = square(options.sure_m + doubt * (options.unsure_m - options.sure_m));
    const double share = before / (before + square(options.off_on_real_depth * network.error_m[j]));
    fused_m.position_m[j] += share * (network.joints_m.position_m[j] - joints_m.position_m[j]);
  }
  return fused_m;
}

}  // namespace ossa::recon
