#pragma once
#include <NiteCTypes.h>

#include "recon/posture.h"

namespace ossa::nite2 {

// Constants: by hand.

/// Bounds of the poses, by hand: wide enough for people who do not know them exactly.
struct PoseOptions {
  double tilt_rad = 0.61;  // 35 degrees: of psi's upper arms from level, forearms from upright
  // Distance of each hand beyond the other, across the body. The tracker keeps crossing hands side
  // by side, while hands that merely touch are two palms apart.
  double crossed_m = 0.0;
  double slack_rad = 0.17;  // hysteresis of a held pose, so that it does not flicker
  double slack_m = 0.05;    // the same for crossed hands
};

/// Whether the body shows the pose. Psi: upper arms level and out, forearms up, as the Greek
/// letter. Crossed hands: between hips and head, each on the other's side. `up`: unit vector in the
/// frame of the posture; `held`: it did in the previous frame.
bool ShowsPose(NitePoseType type, const recon::Posture& posture_m, const Eigen::Vector3d& up,
               bool held, const PoseOptions& options = {});

/// The next NitePoseState when the pose is shown, or not: one frame of ENTER, then IN_POSE; one of
/// EXIT, then DETECTING.
NitePoseState NextPoseState(NitePoseState state, bool shown);

/// Whether the state is one of a pose that is shown.
constexpr bool IsHeld(NitePoseState state) {
  return state == NITE_POSE_STATE_ENTER || state == NITE_POSE_STATE_IN_POSE;
}

}  // namespace ossa::nite2
