#pragma once
#include <algorithm>
#include <array>
#include <vector>

#include "physics/anthropometry.h"
#include "physics/control_internal.h"
#include "physics/ode_internal.h"
#include "recon/posture.h"

namespace ossa::physics {

/// How a character is built.
struct CharacterBuild {
  Control control;
  bool hinges = false;  // at elbows and knees
  int tag = 1;          // in its geoms' data
};

/// Geoms are thicker than limbs by this much, so that contacts are seen coming: at 10 substeps up
/// to 7.5 m/s. contact.cpp takes it off again.
constexpr double kContactMargin_m = 0.025;

/// Where the controller pulls the character during one simulation step.
struct ControlTarget {
  recon::JointArray<Eigen::Vector3d> position_m;
  recon::JointArray<Eigen::Vector3d> velocity_m_s;
  recon::JointOrientations orientation;
  /// World, of the bone that ends in the joint, without its turn about itself.
  recon::JointArray<Eigen::Vector3d> angular_velocity_rad_s;
  /// Scales w per joint, [0, 1]; 0 lets go of the joint (and of its weight).
  recon::JointArray<double> stiffness{};
};

/// 19 capsules and 18 ball joints, or 14 and 4 hinges, in an ODE world. Body i (1..19) is the bone
/// that ends in joint i; its origin is the bone's middle, its y axis points to joint i, its z and x
/// axes are those of recon/orientation.h, so that a body's rotation is the joint's orientation.
class Character {
 public:
  Character(OdeWorld& ode, const Segments& segments, const CharacterBuild& build);
  ~Character();
  Character(const Character&) = delete;
  Character& operator=(const Character&) = delete;

  /// Stands still in the posture, which must have the character's bone lengths.
  void Place(const recon::Posture& posture, const recon::JointOrientations& orientation);
  void SetVelocity(const Eigen::Vector3d& velocity_m_s);
  bool IsFinite() const;

  Eigen::Vector3d JointPosition(size_t joint) const;
  Eigen::Vector3d JointVelocity(size_t joint) const;
  /// Joint positions rebuilt bone by bone, so that lengths are exact although the solver leaves
  /// the anchors of a ball joint a fraction of a millimetre apart.
  recon::Posture posture() const;
  recon::JointOrientations orientation() const;
  double MaxAnchorGap() const;
  /// Closes the gaps that the iterative solver leaves at the joints by moving the bodies' centres,
  /// not their velocities; the centre of mass stays. Called after every substep.
  void Reconnect();
  /// Raises the bodies, not their velocities, until no capsule is deeper than `most_m` in the
  /// plane: a frame of absurd targets leaves the iterative solver with up to 2 cm.
  void LiftOutOf(const Eigen::Vector4d& floor, double most_m);
  double mass_kg() const { return total_mass_kg_; }
  Eigen::Vector3d Momentum() const;

  /// Adds this step's control forces and torques (kPaper) or sets the servos (kMotor).
  void Drive(const ControlTarget& target, const ControlGains& gains,
             const Eigen::Vector3d& gravity_m_s2, double h_s);
  void AddForceAtJoint(size_t joint, const Eigen::Vector3d& force_n);

  dBodyID body(size_t bone) const { return body_[bone]; }
  bool Owns(dBodyID body) const {
    return std::find(body_.begin() + 1, body_.end(), body) != body_.end();
  }
  dGeomID geom(size_t bone) const { return geom_[bone]; }
  const Segments& segments() const { return segments_; }
  /// The last Place: where the joints' anchors in the bodies were taken from.
  const recon::Posture& placed() const { return placed_; }
  const recon::JointOrientations& placed_orientation() const { return placed_orientation_; }
  /// Body whose end (or, for the hip centre, start) is the joint, and the joint's place in it.
  size_t BodyOfJoint(size_t joint) const { return joint == 0 ? 1 : joint; }
  double OffsetOfJoint(size_t joint) const;

 private:
  void MakeBody(OdeWorld& ode, size_t bone, int tag);
  void MakeJoint(OdeWorld& ode, size_t bone, const CharacterBuild& build);
  void MakeMotor(OdeWorld& ode, size_t bone);
  void DrivePositions(const ControlTarget& target, const ControlGains& gains);
  void DriveAxes(const ControlTarget& target, const ControlGains& gains);
  void DriveMotors(const ControlTarget& target, const ControlGains& gains, double h_s);
  void CarryWeight(const ControlTarget& target, const Eigen::Vector3d& gravity_m_s2);

  Segments segments_;
  recon::Posture placed_;
  recon::JointOrientations placed_orientation_;
  recon::JointArray<double> lumped_kg_;
  double total_mass_kg_ = 0.0;
  recon::JointArray<dBodyID> body_{};
  recon::JointArray<dGeomID> geom_{};
  recon::JointArray<dJointID> ball_{};   // or hinge
  recon::JointArray<dJointID> motor_{};  // kMotor only
  dJointID root_motor_ = nullptr;        // linear, kMotor only
};

/// Which body is the other side of bone i's ball joint; 0 for the root bone. The spine bone stands
/// for the pelvis too: the hip bones hang on its start.
constexpr size_t BodyParentOf(size_t bone) {
  if (bone == 1) return 0;
  const size_t parent = recon::ParentOf(bone);
  return parent == 0 ? 1 : parent;
}

/// Pairs of a character's own bones that may touch. Neighbours never do.
const std::vector<std::array<size_t, 2>>& SelfCollisionPairs();

}  // namespace ossa::physics
