#pragma once
#include "recon/posture.h"
#include "recon/refine/pose_network.h"

namespace ossa::recon {

/// How far off joints are expected to be, the mean distance from the true place. Constants: chosen
/// on the development sets of `ossa experiment real`.
struct FusionOptions {
  // Before a pose network has its say, by the forest's confidence in the joint: 1 and 0; metres, >
  // 0.
  double sure_m = 0.03, unsure_m = 0.12;
  /// Where the network puts it, over what the network expects, which knows rendered people alone: a
  /// ratio.
  double off_on_real_depth = 1.5;
  /// Farther apart than so many times both errors together, one of the two is wrong altogether, and
  /// halfway between them is nobody: the surer one counts. A ratio, > 0.
  double contradiction = 2.0;
};

/// Joints by two judges that err apart: the mean of both, each weighted by the inverse of the
/// square of the error that is expected of it. `confidence` in [0, 1].
Posture FusePoses(const Posture& joints_m, const JointArray<double>& confidence,
                  const NetworkPose& network, const FusionOptions& options = {});

}  // namespace ossa::recon
