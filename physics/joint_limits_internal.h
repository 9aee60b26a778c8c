#pragma once
#include <vector>

#include "physics/character_internal.h"

namespace ossa::physics {

/// How far a bone may swing from a direction that its parent carries along, and how far it may turn
/// about itself.
struct JointRange {
  size_t bone = 0;                   // the joint at its end
  Eigen::Vector3d middle_of_parent;  // unit, in the parent bone's frame
  double reach_rad = 0.0;            // half the opening of the cone around it
  double twist_rad = 0.0;            // to either side of the rest pose's; pi: any
};

/// Ranges of head, upper arms, forearms, hands, thighs, shanks and feet.
const std::vector<JointRange>& JointRanges();

/// Beyond its range by an angle, radians (<= 0: within it), about a unit axis of the world that
/// leads back.
struct Excess {
  double angle_rad = 0.0;
  Eigen::Vector3d axis;
};
Excess SwingExcess(const JointRange& range, const recon::JointOrientations& orientation);
Excess TwistExcess(const JointRange& range, const recon::JointOrientations& orientation);

/// The posture with every bone turned into its range, what hangs on it going along; lengths stay. A
/// knee that is to bend forwards is stretched: to turn the thigh instead until it bends backwards,
/// as the frames of ComputeOrientations suggest, would contort the hip for the knee's sake.
recon::Posture WithinRanges(recon::Posture posture);

/// Keeps a character's joints within their ranges: a motor per range, about whatever axes lead
/// back, without torque inside. Its torque is bounded and it is solved with the joints, so a target
/// that asks for the impossible bends it a little and breaks nothing.
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
