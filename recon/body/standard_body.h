#pragma once
#include <Eigen/Core>
#include <array>

#include "recon/body/rig.h"
#include "recon/orientation.h"
#include "recon/posture.h"

namespace ossa::recon {

/// Rest positions of the rig's bones, metres, feet on y = 0, facing +z, left = +x.
struct RigRest {
  std::array<Eigen::Vector3d, kRigBoneCount> head_m;
  std::array<Eigen::Vector3d, kRigBoneCount> tail_m;
};

/// The bone that carries a joint of the SDK, and the joint's position in the rest pose, metres.
struct JointAnchor {
  size_t bone = 0;
  Eigen::Vector3d rest_m = Eigen::Vector3d::Zero();
};

/// The standard average body: MPFB's base mesh plus the mean of the six macro targets
/// {african, asian, caucasian} x {female, male} at age "young", 1.66 m tall. Measured once, so that
/// motion, databases and physics need no body files; a test compares it with the real ones.
const RigRest& StandardRigRest();

/// The 20 joints on the rig. HipCenter: halfway up bone Hips, 5 cm above the hip joints. Spine:
/// head of bone Spine, mid-torso. ShoulderCenter: base of the neck. Head: halfway up bone Head.
/// Hand: halfway from the wrist to the middle finger's knuckle. Foot: root of the middle toe.
const JointArray<JointAnchor>& StandardJointAnchors();

/// World position of every bone's head on the standard body, parents composed before children.
std::array<Eigen::Vector3d, kRigBoneCount> StandardBoneHeads(const RigPose& pose);

/// The 20 joints of the standard body in the pose, in the pose's own world.
Posture StandardPosture(const RigPose& pose);

/// Orientations of the SDK's bones for a pose of the rig, world from bone, in the convention of
/// recon/orientation.h. Unlike orientations from joints they include the twist of the rig's bones.
JointOrientations ComputeOrientations(const RigPose& pose);
/// The same at rest.
const JointOrientations& StandardOrientations();

/// Index of the bone with this rig name. Precondition: the rig has it.
size_t RigBone(std::string_view name);

/// Rotation about the vertical from +z to the direction that the pelvis faces; for lying and
/// upside-down bodies the nearest plausible one.
Eigen::Quaterniond EstimateHeading(const RigPose& pose);

/// The pose turned to face +z with its root above the origin (height kept).
RigPose WithoutHeading(const RigPose& pose);

}  // namespace ossa::recon
