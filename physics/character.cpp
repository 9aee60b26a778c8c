#include <algorithm>
#include <cmath>

#include "physics/character_internal.h"
#include "recon/smallest_turn.h"

namespace ossa::physics {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;
using recon::kJointCount;

Vector3d AxisOf(dBodyID body) {
  const dReal* r = dBodyGetRotation(body);  // row-major 3 x 4
  return {r[1], r[5], r[9]};
}

bool IsHinge(dJointID joint) { return dJointGetType(joint) == dJointTypeHinge; }

}  // namespace

Character::Character(OdeWorld& ode, const Segments& segments, const CharacterBuild& build)
    : segments_(segments), lumped_kg_(LumpedMasses(segments)) {
  for (size_t bone = 1; bone < kJointCount; ++bone) MakeBody(ode, bone, build.tag);
  for (size_t bone = 2; bone < kJointCount; ++bone) MakeJoint(ode, bone, build);
  if (build.control != Control::kMotor) return;
  for (size_t bone = 1; bone < kJointCount; ++bone) MakeMotor(ode, bone);
  root_motor_ = dJointCreateLMotor(ode.world, nullptr);
  dJointAttach(root_motor_, body_[1], nullptr);
  dJointSetLMotorNumAxes(root_motor_, 3);
  for (int axis = 0; axis < 3; ++axis) {
    const Vector3d e = Vector3d::Unit(axis);
    dJointSetLMotorAxis(root_motor_, axis, 0, e.x(), e.y(), e.z());
  }
}

Character::~Character() {
  for (const dGeomID geom : geom_) {
    if (geom != nullptr) dGeomDestroy(geom);
  }
  for (const auto& joints : {ball_, motor_}) {
    for (const dJointID joint : joints) {
      if (joint != nullptr) dJointDestroy(joint);
    }
  }
  if (root_motor_ != nullptr) dJointDestroy(root_motor_);
  for (const dBodyID body : body_) {
    if (body != nullptr) dBodyDestroy(body);
  }
}

void Character::MakeBody(OdeWorld& ode, size_t bone, int tag) {
  const Segment& segment = segments_[bone];
  const dBodyID body = body_[bone] = dBodyCreate(ode.world);
  dMass mass;
  dMassSetParameters(&mass, segment.mass_kg, 0, 0, 0, segment.transverse_inertia_kgm2,
                     segment.axial_inertia_kgm2, segment.transverse_inertia_kgm2, 0, 0, 0);
  dBodySetMass(body, &mass);
  // The explicit gyroscopic term adds energy to thin bodies; for limbs it is far below control
  // forces.
  dBodySetGyroscopicMode(body, 0);
  dBodySetAutoDisableFlag(body, 0);
  dBodySetData(body, reinterpret_cast<void*>(static_cast<intptr_t>(bone)));
  dBodySetMaxAngularSpeed(body, 100.0);
  total_mass_kg_ += segment.mass_kg;

  const double from = segment.capsule_from * segment.length_m;
  const double to = segment.capsule_to * segment.length_m;
  // A foot's capsule ends are centred on its joints, at the height of the sole; other bones share
  // theirs with their neighbours.
  const bool foot = bone == 15 || bone == 19;
  const double cylinder = std::max(to - from - (foot ? 0.0 : segment.radius_m), 0.01);
  const dGeomID geom = geom_[bone] =
      dCreateCapsule(ode.space, segment.radius_m + kContactMargin_m, cylinder);
  dGeomSetBody(geom, body);
  // ODE's capsules lie along z, our bones along y.
  dMatrix3 z_to_y;
  dRFromAxisAndAngle(z_to_y, 1, 0, 0, -0.5 * M_PI);
  dGeomSetOffsetRotation(geom, z_to_y);
  dGeomSetOffsetPosition(geom, 0, 0.5 * (from + to) - 0.5 * segment.length_m, 0);
  dGeomSetData(geom, reinterpret_cast<void*>(static_cast<intptr_t>(tag)));
}

void Character::MakeJoint(OdeWorld& ode, size_t bone, const CharacterBuild& build) {
  const bool hinge = build.hinges && (bone == 6 || bone == 10 || bone == 14 || bone == 18);
  ball_[bone] =
      hinge ? dJointCreateHinge(ode.world, nullptr) : dJointCreateBall(ode.world, nullptr);
  dJointAttach(ball_[bone], body_[bone], body_[BodyParentOf(bone)]);
}

void Character::MakeMotor(OdeWorld& ode, size_t bone) {
  motor_[bone] = dJointCreateAMotor(ode.world, nullptr);
  dJointAttach(motor_[bone], body_[bone], bone == 1 ? nullptr : body_[BodyParentOf(bone)]);
  dJointSetAMotorMode(motor_[bone], dAMotorUser);
  dJointSetAMotorNumAxes(motor_[bone], 3);
  for (int axis = 0; axis < 3; ++axis) {
    const Vector3d e = Vector3d::Unit(axis);
    dJointSetAMotorAxis(motor_[bone], axis, 0, e.x(), e.y(), e.z());
  }
}

double Character::OffsetOfJoint(size_t joint) const {
  return joint == 0 ? -0.5 * segments_[1].length_m : 0.5 * segments_[joint].length_m;
}

void Character::Place(const recon::Posture& posture, const recon::JointOrientations& orientation) {
  placed_ = posture;
  placed_orientation_ = orientation;
  for (size_t bone = 1; bone < kJointCount; ++bone) {
    const auto parent = recon::ParentOf(bone);
    const Vector3d middle = 0.5 * (posture.position_m[bone] + posture.position_m[parent]);
    dBodySetPosition(body_[bone], middle.x(), middle.y(), middle.z());
    SetRotation(body_[bone], orientation[bone]);
    dBodySetForce(body_[bone], 0, 0, 0);
    dBodySetTorque(body_[bone], 0, 0, 0);
  }
  SetVelocity(Vector3d::Zero());
  // A ball joint stores its position in both bodies when the anchor is set.
  for (size_t bone = 2; bone < kJointCount; ++bone) {
    const Vector3d anchor = posture.position_m[recon::ParentOf(bone)];
    if (IsHinge(ball_[bone])) {
      const Vector3d axis = orientation[bone] * Vector3d::UnitX();  // recon/orientation.h
      dJointSetHingeAnchor(ball_[bone], anchor.x(), anchor.y(), anchor.z());
      dJointSetHingeAxis(ball_[bone], axis.x(), axis.y(), axis.z());
    } else {
      dJointSetBallAnchor(ball_[bone], anchor.x(), anchor.y(), anchor.z());
    }
  }
}

void Character::SetVelocity(const Vector3d& velocity_m_s) {
  for (size_t bone = 1; bone < kJointCount; ++bone) {
    dBodySetAngularVel(body_[bone], 0, 0, 0);
    dBodySetLinearVel(body_[bone], velocity_m_s.x(), velocity_m_s.y(), velocity_m_s.z());
  }
}

bool Character::IsFinite() const {
  return std::all_of(body_.begin() + 1, body_.end(), IsFiniteAndNear);
}

Vector3d Character::JointPosition(size_t joint) const {
  const dBodyID body = body_[BodyOfJoint(joint)];
  return ToEigen(dBodyGetPosition(body)) + OffsetOfJoint(joint) * AxisOf(body);
}

Vector3d Character::JointVelocity(size_t joint) const {
  const dBodyID body = body_[BodyOfJoint(joint)];
  return ToEigen(dBodyGetLinearVel(body)) +
         ToEigen(dBodyGetAngularVel(body)).cross(OffsetOfJoint(joint) * AxisOf(body));
}

recon::Posture Character::posture() const {
  recon::Posture posture;
  Vector3d drift = Vector3d::Zero();  // of the rebuilt bones, mass-weighted
  posture.position_m[0] = JointPosition(0);
  for (size_t bone = 1; bone < kJointCount; ++bone) {
    const Vector3d& start = posture.position_m[recon::ParentOf(bone)];
    const Vector3d along = segments_[bone].length_m * AxisOf(body_[bone]).normalized();
    posture.position_m[bone] = start + along;
    drift +=
        segments_[bone].mass_kg * (start + 0.5 * along - ToEigen(dBodyGetPosition(body_[bone])));
  }
  for (auto& p : posture.position_m) p -= drift / total_mass_kg_;
  return posture;
}

recon::JointOrientations Character::orientation() const {
  recon::JointOrientations orientation;
  orientation[0] = Quaterniond::Identity();
  for (size_t bone = 1; bone < kJointCount; ++bone) {
    orientation[bone] = QuaternionToEigen(dBodyGetQuaternion(body_[bone])).normalized();
  }
  return orientation;
}

double Character::MaxAnchorGap() const {
  double gap = 0.0;
  for (size_t bone = 2; bone < kJointCount; ++bone) {
    dVector3 a, b;
    const bool hinge = IsHinge(ball_[bone]);
    (hinge ? dJointGetHingeAnchor : dJointGetBallAnchor)(ball_[bone], a);
    (hinge ? dJointGetHingeAnchor2 : dJointGetBallAnchor2)(ball_[bone], b);
    gap = std::max(gap, (ToEigen(a) - ToEigen(b)).norm());
  }
  return gap;
}

void Character::Reconnect() {
  const recon::Posture whole = posture();
  for (size_t bone = 1; bone < kJointCount; ++bone) {
    const auto parent = recon::ParentOf(bone);
    const Vector3d middle = 0.5 * (whole.position_m[bone] + whole.position_m[parent]);
    dBodySetPosition(body_[bone], middle.x(), middle.y(), middle.z());
  }
}

void Character::LiftOutOf(const Eigen::Vector4d& floor, double most_m) {
  double deepest = 0.0;
  for (size_t bone = 1; bone < kJointCount; ++bone) {
    dReal radius = 0.0, cylinder = 0.0;
    dGeomCapsuleGetParams(geom_[bone], &radius, &cylinder);
    const Vector3d middle = ToEigen(dGeomGetPosition(geom_[bone]));
    const double tilt = std::abs(floor.head<3>().dot(AxisOf(body_[bone])));
    const double lowest =
        floor.head<3>().dot(middle) + floor[3] - 0.5 * cylinder * tilt - segments_[bone].radius_m;
    deepest = std::max(deepest, -lowest);
  }
  if (deepest <= most_m) return;
  const Vector3d by = (deepest - most_m) * floor.head<3>();
  for (size_t bone = 1; bone < kJointCount; ++bone) {
    const Vector3d at = ToEigen(dBodyGetPosition(body_[bone])) + by;
    dBodySetPosition(body_[bone], at.x(), at.y(), at.z());
  }
}

Vector3d Character::Momentum() const {
  Vector3d momentum = Vector3d::Zero();
  for (size_t bone = 1; bone < kJointCount; ++bone) {
    momentum += segments_[bone].mass_kg * ToEigen(dBodyGetLinearVel(body_[bone]));
  }
  return momentum;
}

void Character::AddForceAtJoint(size_t joint, const Vector3d& force_n) {
  const Vector3d at = JointPosition(joint);
  dBodyAddForceAtPos(body_[BodyOfJoint(joint)], force_n.x(), force_n.y(), force_n.z(), at.x(),
                     at.y(), at.z());
}

void Character::Drive(const ControlTarget& target, const ControlGains& gains,
                      const Vector3d& gravity_m_s2, double h_s) {
  CarryWeight(target, gravity_m_s2);
  if (root_motor_ != nullptr) {
    DriveMotors(target, gains, h_s);
  } else {
    DrivePositions(target, gains);
    DriveAxes(target, gains);
  }
}

/// Departure: the controller compensates the weight of a controlled joint; otherwise the character
/// would hang g / w^2 (8 mm) below its target. A released joint falls.
void Character::CarryWeight(const ControlTarget& target, const Vector3d& gravity_m_s2) {
  for (size_t joint = 0; joint < kJointCount; ++joint) {
    if (target.stiffness[joint] > 0.0) AddForceAtJoint(joint, -lumped_kg_[joint] * gravity_m_s2);
  }
}

void Character::DrivePositions(const ControlTarget& target, const ControlGains& gains) {
  for (size_t joint = 0; joint < kJointCount; ++joint) {
    if (target.stiffness[joint] <= 0.0) continue;
    AddForceAtJoint(joint, ControlForce(gains, target.stiffness[joint], lumped_kg_[joint],
                                        target.position_m[joint] - JointPosition(joint),
                                        target.velocity_m_s[joint] - JointVelocity(joint)));
  }
}

/// Eq. 2 / 17. Axial rotation of a bone moves no joint, so each bone is controlled independently.
/// Departure: the target's axial velocity counts as 0. Joints hardly determine axial rotations, so
/// that the difference of two frames would be noise.
void Character::DriveAxes(const ControlTarget& target, const ControlGains& gains) {
  for (size_t bone = 1; bone < kJointCount; ++bone) {
    if (target.stiffness[bone] <= 0.0) continue;
    const Quaterniond now = QuaternionToEigen(dBodyGetQuaternion(body_[bone]));
    const Vector3d axis = AxisOf(body_[bone]);
    // After swinging the target frame onto the current axis, only the axial difference remains.
    const Quaterniond swing =
        recon::SmallestTurn(target.orientation[bone] * Vector3d::UnitY(), axis);
    const Vector3d x_target = swing * (target.orientation[bone] * Vector3d::UnitX());
    const Vector3d x_now = now * Vector3d::UnitX();
    const double angle = std::atan2(axis.dot(x_now.cross(x_target)), x_now.dot(x_target));
    const double rate = axis.dot(ToEigen(dBodyGetAngularVel(body_[bone])));
    const double torque = ControlTorque(gains, target.stiffness[bone],
                                        segments_[bone].axial_inertia_kgm2, angle, -rate);
    const Vector3d t = torque * axis;
    dBodyAddTorque(body_[bone], t.x(), t.y(), t.z());
  }
}

namespace {

void SetMotor(dJointID motor, bool linear, const Vector3d& speed, double bound) {
  constexpr std::array<int, 3> kVelocity = {dParamVel1, dParamVel2, dParamVel3};
  constexpr std::array<int, 3> kBound = {dParamFMax1, dParamFMax2, dParamFMax3};
  for (size_t axis = 0; axis < 3; ++axis) {
    const double v = speed[static_cast<Eigen::Index>(axis)];
    (linear ? dJointSetLMotorParam : dJointSetAMotorParam)(motor, kVelocity[axis], v);
    (linear ? dJointSetLMotorParam : dJointSetAMotorParam)(motor, kBound[axis], bound);
  }
}

}  // namespace

/// The alternative control: an angular servo per ball joint that rotates each bone, relative to its
/// parent, towards the target's orientation, and a linear servo for the trunk. The servo's speed is
/// gain x error. A gain of w / 2 gives the lag of positional control (2 / w); gain h is at most 1/8
/// (LargestStableRate), far below the stability limit of 2. Servos are solved together with the
/// joints, so they are unconditionally stable.
void Character::DriveMotors(const ControlTarget& target, const ControlGains& gains, double h_s) {
  // Share of a bone's angular velocity that its servo gets as feed-forward. 1: 0.37 frames of lag
  // on UI-PRMD and 48 % less jitter than the sensor; 0.7: 0.50 frames and 53 %; 0.4: 0.66 frames
  // and 56 %.
  constexpr double kVelocityShare = 0.7;  // chosen so, between lag and noise
  const double gain = std::min(0.5 * gains.rate_rad_s, 0.5 / h_s);
  for (size_t bone = 1; bone < kJointCount; ++bone) {
    const size_t parent = BodyParentOf(bone);
    const Quaterniond now = QuaternionToEigen(dBodyGetQuaternion(body_[bone]));
    const Quaterniond parent_now = parent == 0
                                       ? Quaterniond::Identity()
                                       : QuaternionToEigen(dBodyGetQuaternion(body_[parent]));
    const Quaterniond parent_target =
        parent == 0 ? Quaterniond::Identity() : target.orientation[parent];
    const Quaterniond wanted = parent_now * parent_target.conjugate() * target.orientation[bone];
    const bool held = target.stiffness[bone] > 0.0;
    // Torque bound: that of the maximum force at the bone's far end, including everything beyond
    // it.
    const double bound = gains.max_acceleration_m_s2 * 0.3 * segments_[bone].length_m *
                         (bone == 1 ? total_mass_kg_ : 4.0 * segments_[bone].mass_kg);
    Vector3d turning = kVelocityShare * target.angular_velocity_rad_s[bone];
    if (parent != 0) turning -= kVelocityShare * target.angular_velocity_rad_s[parent];
    const Vector3d correcting =
        gain * target.stiffness[bone] * recon::ToRotationVector(wanted * now.conjugate());
    SetMotor(motor_[bone], false, correcting + turning, held ? bound : 0.0);
  }
  const Vector3d middle = 0.5 * (target.position_m[0] + target.position_m[1]);
  const Vector3d velocity = 0.5 * (target.velocity_m_s[0] + target.velocity_m_s[1]);
  const Vector3d error = middle - ToEigen(dBodyGetPosition(body_[1]));
  SetMotor(root_motor_, true, gain * target.stiffness[0] * error + velocity,
           target.stiffness[0] > 0.0 ? total_mass_kg_ * gains.max_acceleration_m_s2 : 0.0);
}

}  // namespace ossa::physics
