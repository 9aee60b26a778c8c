#include "recon/motion/bvh_layout_internal.h"
#include "recon/motion/humanoid.h"
#include "recon/t_pose.h"

namespace ossa::recon {
namespace {

using Eigen::Vector3d;

bool IsEnd(const HumanBoneInfo& bone) { return bone.place == bone.turner && bone.parent >= 0; }

bool IsHand(const HumanBoneInfo& bone) {
  return bone.turner == Joint::kHandLeft || bone.turner == Joint::kHandRight;
}

}  // namespace

std::string HumanBoneName(const HumanBoneInfo& bone, BvhNames names) {
  if (names == BvhNames::kVrm || names == BvhNames::kSdk) return std::string(bone.vrm);
  return (names == BvhNames::kMixamo ? "mixamorig:" : "") + std::string(bone.mixamo);
}

BvhLayout HumanoidLayout(BvhNames names, const BoneLengths& lengths,
                         const std::array<Vector3d, 2>& hip_offsets_m) {
  BvhLayout layout;
  layout.place.fill(kNoBvhJoint);
  for (size_t i = 0; i < kHumanBoneCount; ++i) {
    const HumanBoneInfo& human = kHumanBones[i];
    const size_t from = Index(human.place), turns = Index(human.turner);
    BvhJoint joint;
    joint.name = HumanBoneName(human, names);
    joint.parent = human.parent;
    if (from != 0) joint.offset = kBvhCentimetres * lengths[from] * TPoseDirection(from);
    if (human.place == Joint::kHipLeft) joint.offset = kBvhCentimetres * hip_offsets_m[0];
    if (human.place == Joint::kHipRight) joint.offset = kBvhCentimetres * hip_offsets_m[1];
    if (i == 0) {
      joint.channels = {BvhChannel::kXposition, BvhChannel::kYposition, BvhChannel::kZposition};
    }
    for (const BvhChannel turn : BvhTurns()) joint.channels.push_back(turn);
    if (IsEnd(human)) joint.end_sites.push_back(kBvhEnd_cm * TPoseDirection(from));
    if (IsHand(human)) {
      joint.end_sites.push_back(kBvhCentimetres * lengths[turns] * TPoseDirection(turns));
    }
    layout.joints.push_back(joint);
    // End joints follow their parent; other joints drive the next bone.
    (IsEnd(human) ? layout.place[from] : layout.turner[turns]) = i;
  }
  return layout;
}

}  // namespace ossa::recon
