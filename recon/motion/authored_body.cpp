#include "recon/motion/authored_body_internal.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "depth/base/angles.h"
#include "recon/body/standard_body.h"
#include "recon/motion/retarget_internal.h"

namespace ossa::recon {
namespace {

using Eigen::AngleAxisd;
using Eigen::Quaterniond;
using Eigen::Vector3d;

// Constants: chosen by hand.

// People do not stand with locked knees or punch with a locked elbow.
constexpr double kStraightest = 0.995;  // share of the limb's length

const Vector3d kX = Vector3d::UnitX(), kY = Vector3d::UnitY(), kZ = Vector3d::UnitZ();

Quaterniond Turn(double degrees, const Vector3d& axis) {
  return Quaterniond(AngleAxisd(degrees * kDegree, axis));
}

/// Indices of the rig's bones, looked up once.
struct LimbBones {
  size_t collar, arm, fore_arm, hand, finger_base, finger, thumb, hip, up_leg, leg, foot, toe;
};
struct Bones {
  size_t lower_back, spine, spine1, neck, neck1, head;
  std::array<LimbBones, 2> side;
};

const Bones& RigBones() {
  static const Bones bones = [] {
    Bones b{RigBone("LowerBack"),
            RigBone("Spine"),
            RigBone("Spine1"),
            RigBone("Neck"),
            RigBone("Neck1"),
            RigBone("Head"),
            {}};
    for (size_t s = 0; s < 2; ++s) {
      const std::string n = s == 0 ? "Left" : "Right", i = s == 0 ? "L" : "R";
      b.side[s] = {RigBone(n + "Shoulder"), RigBone(n + "Arm"),        RigBone(n + "ForeArm"),
                   RigBone(n + "Hand"),     RigBone(n + "FingerBase"), RigBone(n + "HandFinger1"),
                   RigBone(i + "Thumb"),    RigBone(i + "HipJoint"),   RigBone(n + "UpLeg"),
                   RigBone(n + "Leg"),      RigBone(n + "Foot"),       RigBone(n + "ToeBase")};
    }
    return b;
  }();
  return bones;
}

/// Rotation from one pair of perpendicular directions to another (orthogonalised, the first kept).
Quaterniond FrameTurn(const Vector3d& from, const Vector3d& from_hinge, const Vector3d& to,
                      const Vector3d& to_hinge) {
  const auto frame = [](const Vector3d& along, const Vector3d& hinge) {
    Eigen::Matrix3d m;
    const Vector3d a = along.normalized();
    const Vector3d h = (hinge - hinge.dot(a) * a).normalized();
    m << a, h, a.cross(h);
    return m;
  };
  return Quaterniond(frame(to, to_hinge) * frame(from, from_hinge).transpose());
}

/// Directions of the two bones of a limb that reaches `to_end`, with the middle joint towards
/// `pole`.
struct TwoBones {
  Vector3d upper, lower, hinge;  // hinge = upper x lower, also where the limb is straight
};

TwoBones SolveTwoBones(const Vector3d& to_end, const Vector3d& pole, double upper_m,
                       double lower_m) {
  const double longest = kStraightest * (upper_m + lower_m);
  const double shortest = 0.29 * (upper_m + lower_m);  // elbows and knees bend at most 146°
  const double distance = std::clamp(to_end.norm(), shortest, longest);
  const Vector3d d = to_end.normalized();
  Vector3d p = pole - pole.dot(d) * d;
  p = p.norm() > 1e-6 ? p.normalized() : d.unitOrthogonal();
  const double cosine =
      (upper_m * upper_m + distance * distance - lower_m * lower_m) / (2.0 * upper_m * distance);
  const double angle = std::acos(std::clamp(cosine, -1.0, 1.0));
  TwoBones bones;
  bones.upper = std::cos(angle) * d + std::sin(angle) * p;
  bones.lower = (distance * d - upper_m * bones.upper).normalized();
  bones.hinge = p.cross(d);
  return bones;
}

Vector3d RestBone(size_t bone) {
  return StandardRigRest().tail_m[bone] - StandardRigRest().head_m[bone];
}

/// From shoulder to wrist in the chest's axes, in arm lengths.
Vector3d ArmDirection(const ArmKey& arm, size_t side) {
  const double f = arm.flex * kDegree, a = arm.abduct * kDegree;
  return {SideSign(side) * std::sin(a), -std::cos(a) * std::cos(f), std::cos(a) * std::sin(f)};
}

/// Direction of a relaxed elbow: down, back and outwards; with the hand above the shoulder outwards
/// and forwards.
Vector3d ElbowPole(const Vector3d& direction, double sign, double swivel) {
  const double up = std::clamp(0.5 + 1.2 * (direction.y() - 0.35), 0.0, 1.0);
  const double raised = up * up * (3.0 - 2.0 * up);
  const Vector3d low(0.22 * sign, -0.85, -0.5), high(1.0 * sign, -0.1, 0.35);
  const Vector3d pole = (1.0 - raised) * low + raised * high;
  // A positive angle lifts a hanging elbow outwards.
  return Turn(sign * swivel, direction) * pole;
}

/// World position of the ankle: the foot rotates about its ball with the heel up, about the heel
/// with the toes up.
Vector3d PlaceAnkle(const LegKey& leg, size_t side, double heading, Quaterniond& foot) {
  const RigRest& rest = StandardRigRest();
  const LimbBones& b = RigBones().side[side];
  const Vector3d ankle = rest.head_m[b.foot];
  const Vector3d ground(ankle.x(), 0.0, ankle.z());
  Vector3d ball = rest.tail_m[b.foot], heel(ankle.x(), 0.0, ankle.z() - 0.05);
  ball.y() = 0.0;
  const Quaterniond yaw = Turn(heading + SideSign(side) * leg.yaw, kY);
  foot = yaw * Turn(leg.pitch, kX);
  const Vector3d pivot = leg.pitch > 0 ? ball : heel;
  return leg.foot_m + yaw * (pivot - ground) + foot * (ankle - pivot);
}

struct Feet {
  std::array<Vector3d, 2> ankle;
  std::array<Quaterniond, 2> foot;
};

Vector3d HipJoint(const RigPose& pose, size_t side) {
  const RigRest& rest = StandardRigRest();
  return pose.root_m +
         pose.world_from_rest[0] * (rest.head_m[RigBones().side[side].up_leg] - rest.head_m[0]);
}

double LegLength() {
  const LimbBones& b = RigBones().side[0];
  return kStraightest * (RestBone(b.up_leg).norm() + RestBone(b.leg).norm());
}

/// Lowers the pelvis until the ankles of grounded feet are reachable, smoothly near the limit so
/// that knees do not snap straight.
void LowerToFeet(const BodyKey& key, const Feet& feet, RigPose& pose) {
  double height = pose.root_m.y();
  for (size_t s = 0; s < 2; ++s) {
    const Vector3d hip = HipJoint(pose, s) - feet.ankle[s];
    const double level2 = hip.x() * hip.x() + hip.z() * hip.z();
    const double reach2 = LegLength() * LegLength() - level2;
    if (reach2 <= 0.0) continue;  // a kick beyond reach: the leg points at it
    const double over = hip.y() - std::sqrt(reach2);
    constexpr double kSoft_m = 0.008;
    const double lower = over < -kSoft_m  ? 0.0
                         : over > kSoft_m ? over
                                          : (over + kSoft_m) * (over + kSoft_m) / (4.0 * kSoft_m);
    // A lifted foot does not lower the pelvis.
    const double grounded = std::clamp(1.0 - key.leg[s].foot_m.y() / 0.1, 0.0, 1.0);
    height = std::min(height, pose.root_m.y() - grounded * lower);
  }
  pose.root_m.y() = height;
}

void PoseLegs(const BodyKey& key, const Feet& feet, RigPose& pose) {
  for (size_t s = 0; s < 2; ++s) {
    const LimbBones& b = RigBones().side[s];
    const Vector3d upper = RestBone(b.up_leg), lower = RestBone(b.leg);
    // The knee points in the direction of the foot, and partly of the pelvis.
    const double yaw =
        key.heading + 0.4 * key.twist + SideSign(s) * (0.8 * key.leg[s].yaw + key.leg[s].knee);
    const Vector3d pole = Turn(yaw, kY) * (kZ + 0.25 * kY);
    const TwoBones solved =
        SolveTwoBones(feet.ankle[s] - HipJoint(pose, s), pole, upper.norm(), lower.norm());
    pose.world_from_rest[b.hip] = pose.world_from_rest[0];
    pose.world_from_rest[b.up_leg] = FrameTurn(upper, kX, solved.upper, solved.hinge);
    pose.world_from_rest[b.leg] = FrameTurn(lower, kX, solved.lower, solved.hinge);
    pose.world_from_rest[b.foot] = feet.foot[s];
    pose.world_from_rest[b.toe] =
        key.leg[s].pitch > 0 && key.leg[s].foot_m.y() < 0.02
            ? Turn(key.heading + SideSign(s) * key.leg[s].yaw, kY)  // toes stay in place
            : feet.foot[s];
  }
}

/// Centre of mass from the joints; mass fractions after Winter 2009, table 4.1.
Vector3d ComputeCentreOfMass(const RigPose& pose) {
  const Posture p = StandardPosture(pose);
  struct Segment {
    Joint from, to;
    double centre, mass;
  };
  constexpr std::array<Segment, 12> kSegments = {{
      {Joint::kHipCenter, Joint::kShoulderCenter, 0.45, 0.497},
      {Joint::kShoulderCenter, Joint::kHead, 0.9, 0.081},
      {Joint::kShoulderLeft, Joint::kElbowLeft, 0.436, 0.028},
      {Joint::kElbowLeft, Joint::kHandLeft, 0.6, 0.022},
      {Joint::kShoulderRight, Joint::kElbowRight, 0.436, 0.028},
      {Joint::kElbowRight, Joint::kHandRight, 0.6, 0.022},
      {Joint::kHipLeft, Joint::kKneeLeft, 0.433, 0.1},
      {Joint::kKneeLeft, Joint::kAnkleLeft, 0.433, 0.0465},
      {Joint::kAnkleLeft, Joint::kFootLeft, 0.5, 0.0145},
      {Joint::kHipRight, Joint::kKneeRight, 0.433, 0.1},
      {Joint::kKneeRight, Joint::kAnkleRight, 0.433, 0.0465},
      {Joint::kAnkleRight, Joint::kFootRight, 0.5, 0.0145},
  }};
  Vector3d sum = Vector3d::Zero();
  double mass = 0.0;
  for (const Segment& s : kSegments) {
    sum += s.mass * (p[s.from] + s.centre * (p[s.to] - p[s.from]));
    mass += s.mass;
  }
  return sum / mass;
}

Vector3d FindSupport(const BodyKey& key, const Feet& feet) {
  std::array<Vector3d, 2> middle;
  for (size_t s = 0; s < 2; ++s) {
    // The weight rests in front of the ankle; on the ball when the heel is up.
    const double ahead_m = 0.045 + 0.08 * std::clamp(key.leg[s].pitch / 30.0, 0.0, 1.0);
    middle[s] = feet.ankle[s] +
                Turn(key.heading + SideSign(s) * key.leg[s].yaw, kY) * Vector3d(0, 0, ahead_m);
  }
  return key.weight * middle[0] + (1.0 - key.weight) * middle[1];
}

/// Moves the pelvis until the centre of mass is above the support.
void Balance(const BodyKey& key, const Feet& feet, RigPose& pose) {
  if (key.balance <= 0.0) return;
  const Vector3d lean = Turn(key.heading, kY) * Vector3d(key.lean_left_m, 0.0, key.lean_front_m);
  const Vector3d support = FindSupport(key, feet) + lean;
  // The legs' mass moves less than the pelvis: a few iterations converge.
  for (int round = 0; round < 4; ++round) {
    pose.root_m.y() = key.pelvis_m.y();
    LowerToFeet(key, feet, pose);
    PoseLegs(key, feet, pose);
    const Vector3d off = support - ComputeCentreOfMass(pose);
    pose.root_m += Vector3d(off.x(), 0.0, off.z());
  }
  pose.root_m = key.pelvis_m + key.balance * (pose.root_m - key.pelvis_m);
  pose.root_m.y() = key.pelvis_m.y();
}

/// Rotation by a `share` of the bend of trunk or neck.
Quaterniond Bend(double forwards, double left, double turn, double share) {
  return Turn(turn * share, kY) * Turn(forwards * share, kX) * Turn(-left * share, kZ);
}

}  // namespace

void PoseArm(const ArmKey& arm, size_t side, RigPose& pose) {
  const LimbBones& b = RigBones().side[side];
  const Vector3d upper = RestBone(b.arm), lower = RestBone(b.fore_arm);
  const Vector3d direction = ArmDirection(arm, side);
  const TwoBones solved =
      SolveTwoBones(direction * (arm.reach * (upper.norm() + lower.norm())),
                    ElbowPole(direction, SideSign(side), arm.swivel), upper.norm(), lower.norm());
  const Vector3d rest_hinge = upper.cross(lower);
  const Quaterniond chest = pose.world_from_rest[RigBones().spine1];
  pose.world_from_rest[b.collar] = chest;
  pose.world_from_rest[b.arm] = chest * FrameTurn(upper, rest_hinge, solved.upper, solved.hinge);
  const Quaterniond hand = chest * Turn(SideSign(side) * arm.pronate, solved.lower) *
                           FrameTurn(lower, rest_hinge, solved.lower, solved.hinge);
  for (const size_t bone : {b.fore_arm, b.hand, b.finger_base, b.finger, b.thumb}) {
    pose.world_from_rest[bone] = hand;
  }
}

void PoseTrunk(const BodyKey& key, RigPose& pose) {
  const Bones& b = RigBones();
  auto& r = pose.world_from_rest;
  r[0] = Turn(key.heading + key.twist, kY) * Turn(key.pitch, kX) * Turn(key.roll, kZ);
  // The lumbar spine bends forwards most, the chest turns most (White & Panjabi 1990).
  r[b.lower_back] = r[0] * Turn(key.turn * 0.2, kY) * Bend(key.bend, key.side, 0.0, 0.38);
  r[b.spine] = r[b.lower_back] * Turn(key.turn * 0.35, kY) * Bend(key.bend, key.side, 0.0, 0.34);
  r[b.spine1] = r[b.spine] * Turn(key.turn * 0.45, kY) * Bend(key.bend, key.side, 0.0, 0.28);
  r[b.neck] = r[b.spine1] * Bend(key.nod, key.tilt, key.look, 0.3);
  r[b.neck1] = r[b.neck] * Bend(key.nod, key.tilt, key.look, 0.3);
  r[b.head] = r[b.neck1] * Bend(key.nod, key.tilt, key.look, 0.4);
}

BodyKey::BodyKey() {
  for (size_t s = 0; s < 2; ++s) {
    leg[s].foot_m = Vector3d(SideSign(s) * 0.11, 0.0, 0.0);
    leg[s].yaw = 4.0;  // the rig's feet are rotated outwards by 6° at rest
  }
}

BodyKeyNumbers ToNumbers(const BodyKey& k) {
  BodyKeyNumbers n{k.pelvis_m.x(), k.pelvis_m.y(), k.pelvis_m.z(), k.heading, k.pitch,
                   k.roll,         k.twist,        k.bend,         k.side,    k.turn,
                   k.nod,          k.look,         k.tilt,         k.weight,  k.balance,
                   k.lean_left_m,  k.lean_front_m};
  size_t i = 17;
  for (const ArmKey& a : k.arm) {
    for (const double v : {a.flex, a.abduct, a.reach, a.swivel, a.pronate}) n[i++] = v;
  }
  for (const LegKey& l : k.leg) {
    for (const double v : {l.foot_m.x(), l.foot_m.y(), l.foot_m.z(), l.pitch, l.yaw, l.knee}) {
      n[i++] = v;
    }
  }
  return n;
}

BodyKey ToKey(const BodyKeyNumbers& n) {
  BodyKey k;
  k.pelvis_m = {n[0], n[1], n[2]};
  k.heading = n[3], k.pitch = n[4], k.roll = n[5], k.twist = n[6];
  k.bend = n[7], k.side = n[8], k.turn = n[9];
  k.nod = n[10], k.look = n[11], k.tilt = n[12], k.weight = n[13], k.balance = n[14];
  k.lean_left_m = n[15], k.lean_front_m = n[16];
  size_t i = 17;
  for (ArmKey& a : k.arm) {
    a = {n[i], n[i + 1], n[i + 2], n[i + 3], n[i + 4]};
    i += 5;
  }
  for (LegKey& l : k.leg) {
    l = {{n[i], n[i + 1], n[i + 2]}, n[i + 3], n[i + 4], n[i + 5]};
    i += 6;
  }
  return k;
}

BodyKey Mirrored(const BodyKey& key) {
  BodyKey m = key;
  std::swap(m.arm[0], m.arm[1]);
  std::swap(m.leg[0], m.leg[1]);
  for (LegKey& leg : m.leg) leg.foot_m.x() = -leg.foot_m.x();
  m.pelvis_m.x() = -m.pelvis_m.x();
  m.lean_left_m = -m.lean_left_m;
  for (double* angle : {&m.heading, &m.roll, &m.twist, &m.side, &m.turn, &m.look, &m.tilt}) {
    *angle = -*angle;
  }
  m.weight = 1.0 - m.weight;
  return m;
}

RigPose ComputePose(const BodyKey& key) {
  RigPose pose;
  pose.root_m = key.pelvis_m;
  PoseTrunk(key, pose);
  for (size_t s = 0; s < 2; ++s) PoseArm(key.arm[s], s, pose);
  FollowArmsWithCollars(pose);
  Feet feet;
  for (size_t s = 0; s < 2; ++s) {
    feet.ankle[s] = PlaceAnkle(key.leg[s], s, key.heading, feet.foot[s]);
  }
  Balance(key, feet, pose);
  LowerToFeet(key, feet, pose);
  PoseLegs(key, feet, pose);
  return pose;
}

void ReachFor(BodyKey& key, size_t side, const Vector3d& target_m) {
  const RigRest& rest = StandardRigRest();
  const Bones& b = RigBones();
  const LimbBones& limb = b.side[side];
  const double length = RestBone(limb.arm).norm() + RestBone(limb.fore_arm).norm();
  const Vector3d target =
      rest.head_m[b.neck] + Vector3d(SideSign(side) * target_m.x(), target_m.y(), target_m.z());
  Vector3d shoulder = rest.head_m[limb.arm];
  // The shoulder follows the arm by way of the collar: a few iterations converge.
  for (int round = 0; round < 5; ++round) {
    const Vector3d d = target - shoulder;
    const double distance = d.norm();
    key.arm[side].reach = std::clamp(distance / length, 0.15, 0.99);
    const Vector3d u = d / distance;
    key.arm[side].abduct = std::asin(std::clamp(SideSign(side) * u.x(), -1.0, 1.0)) / kDegree;
    key.arm[side].flex = std::atan2(u.z(), -u.y()) / kDegree;
    if (key.arm[side].flex < -120.0) key.arm[side].flex += 360.0;
    RigPose pose;
    PoseArm(key.arm[side], side, pose);
    FollowArmsWithCollars(pose);
    shoulder = rest.head_m[limb.collar] + pose.world_from_rest[limb.collar] *
                                              (rest.head_m[limb.arm] - rest.head_m[limb.collar]);
  }
}

void ReachForInWorld(BodyKey& key, size_t side, const Vector3d& place_m) {
  const Bones& b = RigBones();
  // The arms' weight moves the pelvis a little: a few iterations converge.
  for (int round = 0; round < 3; ++round) {
    const RigPose pose = ComputePose(key);
    const Vector3d from_neck =
        pose.world_from_rest[b.spine1].conjugate() * (place_m - StandardBoneHeads(pose)[b.neck]);
    ReachFor(key, side, {SideSign(side) * from_neck.x(), from_neck.y(), from_neck.z()});
  }
}

}  // namespace ossa::recon
