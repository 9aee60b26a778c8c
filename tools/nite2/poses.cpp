#include "tools/nite2/poses.h"

#include <algorithm>
#include <cmath>

namespace ossa::nite2 {
namespace {

using Eigen::Vector3d;
using recon::Joint;

bool IsPsiArm(const Vector3d& shoulder, const Vector3d& elbow, const Vector3d& hand,
              const Vector3d& up, double tilt_rad) {
  const double upper_rise = (elbow - shoulder).normalized().dot(up);
  const double fore_rise = (hand - elbow).normalized().dot(up);
  return std::abs(upper_rise) <= std::sin(tilt_rad) && fore_rise >= std::cos(tilt_rad);
}

bool ShowsPsi(const recon::Posture& p, const Vector3d& up, double tilt_rad) {
  return IsPsiArm(p[Joint::kShoulderLeft], p[Joint::kElbowLeft], p[Joint::kHandLeft], up,
                  tilt_rad) &&
         IsPsiArm(p[Joint::kShoulderRight], p[Joint::kElbowRight], p[Joint::kHandRight], up,
                  tilt_rad);
}

bool ShowsCrossedHands(const recon::Posture& p, const Vector3d& up, double crossed_m) {
  const Vector3d leftwards = (p[Joint::kShoulderLeft] - p[Joint::kShoulderRight]).normalized();
  const Vector3d &left = p[Joint::kHandLeft], &right = p[Joint::kHandRight];
  const double low = p[Joint::kHipCenter].dot(up), high = p[Joint::kHead].dot(up);
  const bool beside_trunk =
      std::min(left.dot(up), right.dot(up)) > low && std::max(left.dot(up), right.dot(up)) < high;
  return beside_trunk && (right - left).dot(leftwards) >= crossed_m;
}

}  // namespace

bool ShowsPose(NitePoseType type, const recon::Posture& posture_m, const Vector3d& up, bool held,
               const PoseOptions& options) {
  if (type == NITE_POSE_PSI) {
    return ShowsPsi(posture_m, up, options.tilt_rad + (held ? options.slack_rad : 0.0));
  }
  return ShowsCrossedHands(posture_m, up, options.crossed_m - (held ? options.slack_m : 0.0));
}

NitePoseState NextPoseState(NitePoseState state, bool shown) {
  if (shown) return IsHeld(state) ? NITE_POSE_STATE_IN_POSE : NITE_POSE_STATE_ENTER;
  return IsHeld(state) ? NITE_POSE_STATE_EXIT : NITE_POSE_STATE_DETECTING;
}

}  // namespace ossa::nite2
