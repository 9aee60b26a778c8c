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
  int tag = 1;          // tag in its geoms' data
};

/// Margin by which geoms are thicker than limbs, so that contacts are detected early: at 10
/// substeps up to 7.5 m/s. contact.cpp subtracts it again.
constexpr double kContactMargin_m = 0.025;

/// Where the controller pulls the character during one simulation step.
struct ControlTarget {
  recon::JointArray<Eigen::Vector3d> position_m;
  recon::JointArray<Eigen::Vector3d> velocity_m_s;
  recon::JointOrientations orientation;
  /// In world axes, of the bone that ends in the joint, without axial rotation.
  recon::JointArray<Eigen::Vector3d> angular_velocity_rad_s;
  /// Scales w per joint, [0, 1]; 0 releases the joint (and its weight).
  recon::JointArray<double> stiffness{};
};

/// A character of 19 capsules and 18 ball joints, or 14 and 4 hinges, in an ODE world. Body i
/// (1..19) is the bone that ends in joint i; its origin is the bone's middle, its y axis points to
/// joint i, its z and x axes are those of recon/orientation.h, so a body's rotation is the joint's
/// orientation.
class Character {
 public:
  Character(OdeWorld& ode, const Segments& segments, const CharacterBuild& build);
  ~Character();
  Character(const Character&) = delete;
  Character& operator=(const Character&) = delete;

  /// Places it at rest in the posture, which must have the character's bone lengths.
  void Place(const recon::Posture& posture, const recon::JointOrientations& orientation);
  void SetVelocity(const Eigen::Vector3d& velocity_m_s);
  bool IsFinite() const;

  Eigen::Vector3d JointPosition(size_t joint) const;
  Eigen::Vector3d JointVelocity(size_t joint) const;
  /// Joint positions by forward kinematics, so that lengths are exact although the solver leaves
  /// ball joint anchors a fraction of a millimetre apart.
  recon::Posture posture() const;
  recon::JointOrientations orientation() const;
  double MaxAnchorGap() const;
  /// Closes gaps left by the iterative solver at the joints by moving the bodies, without changing
  /// velocities or the centre of mass. Called after every substep.
  void Reconnect();
  /// Raises the bodies, without changing velocities, until no capsule penetrates the plane by more
  /// than `most_m`: implausible targets can leave up to 2 cm.
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
  /// The posture of the last Place, which defined the joint anchors in the bodies.
  const recon::Posture& placed() const { return placed_; }
  const recon::JointOrientations& placed_orientation() const { return placed_orientation_; }
  /// Body whose end (for HipCenter: start) is the joint, and the joint's position in it.
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
  recon::JointArray<dJointID> ball_{};   // ball joint or hinge
  recon::JointArray<dJointID> motor_{};  // kMotor only
  dJointID root_motor_ = nullptr;        // linear, kMotor only
};

/// The other body of bone i's ball joint; 0 for the root bone. The spine bone also represents the
/// pelvis: the hip bones are attached to its start.
constexpr size_t BodyParentOf(size_t bone) {
  if (bone == 1) return 0;
  const size_t parent = recon::ParentOf(bone);
  return parent == 0 ? 1 : parent;
}

/// Pairs of a character's own bones that may collide. Neighbours never do.
const std::vector<std::array<size_t, 2>>& SelfCollisionPairs();

}  // namespace ossa::physics
