// The hierarchy that tools for avatars expect: bones turn about where they begin, branches hang
// from their common parent.
#include "recon/motion/bvh_layout_internal.h"

namespace ossa::recon {
namespace {

using Eigen::Vector3d;

/// A joint of the file. It lies where the bone `from` ends, or at the hips, and turns the bone
/// `turns`.
struct HumanoidJoint {
  const char* mixamo;  // without its prefix, CMU's name
  const char* vrm;
  int parent;
  Joint from;
  Joint turns;
};
constexpr std::array<HumanoidJoint, 21> kHumanoid = {{
    {"Hips", "hips", -1, Joint::kHipCenter, Joint::kHipCenter},
    {"Spine", "spine", 0, Joint::kHipCenter, Joint::kSpine},
    {"Spine1", "chest", 1, Joint::kSpine, Joint::kShoulderCenter},
    {"Neck", "neck", 2, Joint::kShoulderCenter, Joint::kHead},
    {"Head", "head", 3, Joint::kHead, Joint::kHead},
    {"LeftShoulder", "leftShoulder", 2, Joint::kShoulderCenter, Joint::kShoulderLeft},
    {"LeftArm", "leftUpperArm", 5, Joint::kShoulderLeft, Joint::kElbowLeft},
    {"LeftForeArm", "leftLowerArm", 6, Joint::kElbowLeft, Joint::kWristLeft},
    {"LeftHand", "leftHand", 7, Joint::kWristLeft, Joint::kHandLeft},
    {"RightShoulder", "rightShoulder", 2, Joint::kShoulderCenter, Joint::kShoulderRight},
    {"RightArm", "rightUpperArm", 9, Joint::kShoulderRight, Joint::kElbowRight},
    {"RightForeArm", "rightLowerArm", 10, Joint::kElbowRight, Joint::kWristRight},
    {"RightHand", "rightHand", 11, Joint::kWristRight, Joint::kHandRight},
    {"LeftUpLeg", "leftUpperLeg", 0, Joint::kHipLeft, Joint::kKneeLeft},
    {"LeftLeg", "leftLowerLeg", 13, Joint::kKneeLeft, Joint::kAnkleLeft},
    {"LeftFoot", "leftFoot", 14, Joint::kAnkleLeft, Joint::kFootLeft},
    {"LeftToeBase", "leftToes", 15, Joint::kFootLeft, Joint::kFootLeft},
    {"RightUpLeg", "rightUpperLeg", 0, Joint::kHipRight, Joint::kKneeRight},
    {"RightLeg", "rightLowerLeg", 17, Joint::kKneeRight, Joint::kAnkleRight},
    {"RightFoot", "rightFoot", 18, Joint::kAnkleRight, Joint::kFootRight},
    {"RightToeBase", "rightToes", 19, Joint::kFootRight, Joint::kFootRight},
}};

std::string NameOf(const HumanoidJoint& joint, BvhNames names) {
  if (names == BvhNames::kVrm) return joint.vrm;
  return names == BvhNames::kMixamo ? std::string("mixamorig:") + joint.mixamo : joint.mixamo;
}

bool IsEnd(const HumanoidJoint& joint) { return joint.from == joint.turns && joint.parent >= 0; }

bool IsHand(const HumanoidJoint& joint) {
  return joint.turns == Joint::kHandLeft || joint.turns == Joint::kHandRight;
}

}  // namespace

BvhLayout HumanoidLayout(BvhNames names, const BoneLengths& lengths,
                         const std::array<Vector3d, 2>& hip_offsets_m) {
  BvhLayout layout;
  layout.place.fill(kNoBvhJoint);
  for (size_t i = 0; i < kHumanoid.size(); ++i) {
    const HumanoidJoint& human = kHumanoid[i];
    const size_t from = Index(human.from), turns = Index(human.turns);
    BvhJoint joint;
    joint.name = NameOf(human, names);
    joint.parent = human.parent;
    if (from != 0) joint.offset = kBvhCentimetres * lengths[from] * RestDirection(from);
    if (human.from == Joint::kHipLeft) joint.offset = kBvhCentimetres * hip_offsets_m[0];
    if (human.from == Joint::kHipRight) joint.offset = kBvhCentimetres * hip_offsets_m[1];
    if (i == 0) {
      joint.channels = {BvhChannel::kXposition, BvhChannel::kYposition, BvhChannel::kZposition};
    }
    for (const BvhChannel turn : BvhTurns()) joint.channels.push_back(turn);
    if (IsEnd(human)) joint.end_sites.push_back(kBvhEnd_cm * RestDirection(from));
    if (IsHand(human)) {
      joint.end_sites.push_back(kBvhCentimetres * lengths[turns] * RestDirection(turns));
    }
    layout.joints.push_back(joint);
    // What ends a chain is carried along; whatever else lies there turns the next bone.
    (IsEnd(human) ? layout.place[from] : layout.turner[turns]) = i;
  }
  return layout;
}

}  // namespace ossa::recon
