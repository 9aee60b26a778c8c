#pragma once
#include <Eigen/Core>
#include <array>

#include "recon/body/rig.h"

namespace ossa::recon {

/// The sign of x of a side: 1 for the left (0), -1 for the right (1).
inline double SideSign(size_t side) { return side == 0 ? 1.0 : -1.0; }

/// One arm, by the direction of the wrist from the shoulder, in the chest's axes. Angles are
/// degrees. flex: 0 hanging, 90 forwards, 180 upright, negative backwards; abduct: outwards from
/// there, 90 straight to the side, 165 nearly upright through the side, negative across the chest.
struct ArmKey {
  double flex = 4.0;
  double abduct = 11.0;
  double reach = 0.97;   // distance from the shoulder, of the arm's length: 1 is a straight elbow
  double swivel = 0.0;   // turns the elbow about the line shoulder-wrist; positive: outwards and up
  double pronate = 0.0;  // forearm about itself; positive: palm down in front of the body
};

/// One foot: position below the ankle on the ground, in the clip's world, metres; angles in
/// degrees.
struct LegKey {
  Eigen::Vector3d foot_m = Eigen::Vector3d::Zero();  // y: height of the sole
  double pitch = 0.0;  // positive: heel up, about the ball of the foot; negative: toes up
  double yaw = 0.0;    // positive: toes outwards
  double knee = 0.0;   // rotates the knee outwards
};

/// A key posture in high-level terms: weight, bends of the trunk, positions of hands and feet. Each
/// number can be interpolated independently. Degrees and metres.
struct BodyKey {
  Eigen::Vector3d pelvis_m = Eigen::Vector3d(0.0, 0.862, 0.0);  // y: at most, legs may not reach
  double heading = 0.0;                          // positive: towards the person's left
  double pitch = 0.0;                            // pelvis; positive: forwards
  double roll = 0.0;                             // pelvis; positive: left side up
  double twist = 0.0;                            // pelvis against heading
  double bend = 0.0;                             // trunk above the pelvis, positive: forwards
  double side = 0.0;                             // positive: to the left
  double turn = 0.0;                             // positive: to the left
  double nod = 0.0;                              // head against chest, positive: down
  double look = 0.0;                             // positive: to the left
  double tilt = 0.0;                             // positive: to the left
  double weight = 0.5;                           // share of the weight on the left foot
  double lean_left_m = 0.0, lean_front_m = 0.0;  // centre of mass off the support, when balanced
  double balance = 1.0;       // 0: the pelvis is above pelvis_m; 1: where the body is balanced
  std::array<ArmKey, 2> arm;  // left, right
  std::array<LegKey, 2> leg;  // left, right

  BodyKey();
};

// Derived: what a key posture's fields hold
inline constexpr size_t kBodyKeyNumbers = 17 + 2 * 5 + 2 * 6;
using BodyKeyNumbers = std::array<double, kBodyKeyNumbers>;
BodyKeyNumbers ToNumbers(const BodyKey& key);
BodyKey ToKey(const BodyKeyNumbers& numbers);

/// The mirrored posture: left and right exchanged.
BodyKey Mirrored(const BodyKey& key);

/// The posture on the standard body: two-bone inverse kinematics of arms and legs (law of cosines),
/// trunk bends shared over the rig's spine bones, collars following the arms, the pelvis lowered
/// until the feet are reached and moved until the body is balanced.
RigPose ComputePose(const BodyKey& key);

/// Parts of ComputePose: pelvis, spine, neck and head; an arm, after the trunk. The root stays.
void PoseTrunk(const BodyKey& key, RigPose& pose);
void PoseArm(const ArmKey& arm, size_t side, RigPose& pose);

/// Sets flex, abduct and reach of an arm so that the wrist is at `target_m`: outwards, up and
/// forwards from the base of the neck, in the chest's axes.
void ReachFor(BodyKey& key, size_t side, const Eigen::Vector3d& target_m);

/// As ReachFor, for a position in the clip's world; set trunk and legs of `key` first.
void ReachForInWorld(BodyKey& key, size_t side, const Eigen::Vector3d& place_m);

}  // namespace ossa::recon
