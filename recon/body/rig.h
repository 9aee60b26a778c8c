#pragma once
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <string>
#include <string_view>
#include <vector>

namespace ossa::recon {

/// The 31 bones of the MPFB rig `cmu_mb`, parents before children.
inline constexpr int kRigBoneCount = 31;  // MPFB's format
/// Names of the rig's bones, parents first.
inline constexpr std::array<std::string_view, kRigBoneCount> kRigBoneNames = {
    "Hips",         "LHipJoint",      "LeftUpLeg",       "LeftLeg",         "LeftFoot",
    "LeftToeBase",  "RHipJoint",      "RightUpLeg",      "RightLeg",        "RightFoot",
    "RightToeBase", "LowerBack",      "Spine",           "Spine1",          "Neck",
    "Neck1",        "Head",           "LeftShoulder",    "LeftArm",         "LeftForeArm",
    "LeftHand",     "LeftFingerBase", "LeftHandFinger1", "LThumb",          "RightShoulder",
    "RightArm",     "RightForeArm",   "RightHand",       "RightFingerBase", "RightHandFinger1",
    "RThumb"};
/// Each bone's parent, -1 for the root.
inline constexpr std::array<int, kRigBoneCount> kRigBoneParent = {
    -1, 0,  1,  2,  3,  4,  0,  6,  7,  8,  9,  0,  11, 12, 13, 14,
    15, 13, 17, 18, 19, 20, 21, 20, 13, 24, 25, 26, 27, 28, 26};

/// A pose of the rig, independent of the body's shape. World: metres, y up; a person at rest stands
/// on y = 0 facing +z with its left side at +x.
struct RigPose {
  // Head of bone Hips; for a body of the average height
  Eigen::Vector3d root_m = Eigen::Vector3d::Zero();
  /// Rotation of each bone from its rest (the rig's own A-pose) to the world. Global, not relative
  /// to the parent; identity everywhere is the rest pose.
  std::array<Eigen::Quaterniond, kRigBoneCount> world_from_rest;

  RigPose() { world_from_rest.fill(Eigen::Quaterniond::Identity()); }
};

/// Motion retargeted to the rig.
struct MotionClip {
  std::string name;     // e.g. "05_03" or "authored/walk/3"
  std::string subject;  // the performer, for splits; "" when unknown
  double frame_s = 1.0 / 30.0;
  std::vector<RigPose> frames;
  /// Warnings about its file, one line each.
  std::vector<std::string> warnings{};
};

}  // namespace ossa::recon
