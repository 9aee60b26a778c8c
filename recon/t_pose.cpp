#include "recon/t_pose.h"

namespace ossa::recon {

using Eigen::Vector3d;

Vector3d TPoseDirection(size_t joint) {
  switch (static_cast<Joint>(joint)) {
    case Joint::kSpine:
    case Joint::kShoulderCenter:
    case Joint::kHead:
      return Vector3d::UnitY();
    case Joint::kShoulderLeft:
    case Joint::kElbowLeft:
    case Joint::kWristLeft:
    case Joint::kHandLeft:
    case Joint::kHipLeft:
      return Vector3d::UnitX();
    case Joint::kShoulderRight:
    case Joint::kElbowRight:
    case Joint::kWristRight:
    case Joint::kHandRight:
    case Joint::kHipRight:
      return -Vector3d::UnitX();
    case Joint::kFootLeft:
    case Joint::kFootRight:
      return Vector3d::UnitZ();
    default:
      return -Vector3d::UnitY();
  }
}

Posture BuildTPose(const BoneLengths& lengths_m) {
  Posture posture;
  for (size_t j = 1; j < kJointCount; ++j) {
    posture.position_m[j] = posture.position_m[ParentOf(j)] + lengths_m[j] * TPoseDirection(j);
  }
  return posture;
}

}  // namespace ossa::recon
