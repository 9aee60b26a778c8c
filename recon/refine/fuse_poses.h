#pragma once
#include "recon/posture.h"
#include "recon/refine/pose_network.h"

namespace ossa::recon {

/// Expected errors of joints, as mean distance from the true position. Constants: chosen on the
/// development sets of `ossa experiment real`, and those of the cascade also on recordings with the
/// Kinect SDK's joints (UTD-MHAD, Chen et al. 2015).
struct FusionOptions {
  // Without a pose network, at a forest confidence of 1 and of 0; metres, > 0.
  double sure_m = 0.03, unsure_m = 0.2;
  /// ... and, at a confidence of 0, at least this ratio of the network's error: what hides a joint
  /// from the network hides it from the cascade, too.
  double unseen_ratio = 1.25;
  /// Ratio of the network's error on real depth to the error it predicts, which is learned from
  /// rendered people.
  double off_on_real_depth = 1.5;
  /// If both are farther apart than this multiple of their combined errors, one is entirely wrong
  /// and their mean would be, too: the more certain one is used. A ratio, > 0.
  double contradiction = 2.0;
};

/// Fuses two independent estimates of the joints: the mean weighted by the inverse square of the
/// expected errors. `confidence` in [0, 1].
Posture FusePoses(const Posture& joints_m, const JointArray<double>& confidence,
                  const NetworkPose& network, const FusionOptions& options = {});

}  // namespace ossa::recon
