#pragma once
#include <vector>

#include "physics/character_internal.h"

namespace ossa::physics {

/// The allowed swing of a bone from a direction fixed to its parent, and its allowed axial
/// rotation.
struct JointRange {
  size_t bone = 0;                                             // joint at its end
  Eigen::Vector3d middle_of_parent = Eigen::Vector3d::Zero();  // unit, in the parent bone's frame
  double reach_rad = 0.0;                                      // half-angle of the cone
  double twist_rad = 0.0;  // to either side of the rest pose; pi: unlimited
};

/// Ranges of head, upper arms, forearms, hands, thighs, shanks and feet.
const std::vector<JointRange>& JointRanges();

/// Angle beyond the range, radians (<= 0: within it), and the unit axis in the world that leads
/// back.
struct Excess {
  double angle_rad = 0.0;
  Eigen::Vector3d axis = Eigen::Vector3d::Zero();
};
Excess SwingExcess(const JointRange& range, const recon::JointOrientations& orientation);
Excess TwistExcess(const JointRange& range, const recon::JointOrientations& orientation);

/// The posture with every bone rotated into its range, together with everything attached to it;
/// lengths are kept. A knee that bends forwards is straightened: rotating the thigh instead until
/// it bends backwards, as the frames of ComputeOrientations suggest, would contort the hip.
recon::Posture WithinRanges(recon::Posture posture);

/// Enforces a character's joint ranges: one angular motor per range, about the axes that lead back,
/// without torque inside the range. Its torque is limited and solved together with the joints, so
/// an impossible target bends it slightly and is not unstable.
class JointLimits {
 public:
  JointLimits(OdeWorld& ode, const Character& character);
  ~JointLimits();
  JointLimits(const JointLimits&) = delete;
  JointLimits& operator=(const JointLimits&) = delete;

  /// Before each substep of h seconds.
  void Update(double h_s);

 private:
  const Character& character_;
  std::vector<dJointID> motor_;  // as JointRanges
};

}  // namespace ossa::physics
