#include "recon/body/standard_body.h"

#include <cmath>
#include <stdexcept>
#include <string>

namespace ossa::recon {
namespace {

struct BoneEnds {
  double head[3];
  double tail[3];
};

// Means of the joint cubes of MPFB's rig.cmu_mb on the average mesh (standard_body.h), metres,
// rounded to 0.1 mm, soles moved to y = 0.
constexpr std::array<BoneEnds, kRigBoneCount> kRestEnds = {{
    {{0.0000, 0.8737, 0.0132}, {0.0000, 0.9535, -0.0255}},   // Hips
    {{0.0000, 0.8737, 0.0132}, {0.1014, 0.8657, 0.0049}},    // LHipJoint
    {{0.1014, 0.8657, 0.0049}, {0.1425, 0.4747, 0.0374}},    // LeftUpLeg
    {{0.1425, 0.4747, 0.0374}, {0.1806, 0.0692, 0.0227}},    // LeftLeg
    {{0.1806, 0.0692, 0.0227}, {0.1945, 0.0245, 0.1535}},    // LeftFoot
    {{0.1945, 0.0245, 0.1535}, {0.1962, 0.0221, 0.1716}},    // LeftToeBase
    {{0.0000, 0.8737, 0.0132}, {-0.1014, 0.8657, 0.0049}},   // RHipJoint
    {{-0.1014, 0.8657, 0.0049}, {-0.1425, 0.4747, 0.0374}},  // RightUpLeg
    {{-0.1425, 0.4747, 0.0374}, {-0.1806, 0.0692, 0.0227}},  // RightLeg
    {{-0.1806, 0.0692, 0.0227}, {-0.1945, 0.0245, 0.1535}},  // RightFoot
    {{-0.1945, 0.0245, 0.1535}, {-0.1962, 0.0221, 0.1716}},  // RightToeBase
    {{0.0000, 0.9535, -0.0255}, {0.0000, 1.0948, -0.0084}},  // LowerBack
    {{0.0000, 1.0948, -0.0084}, {0.0000, 1.2387, -0.0187}},  // Spine
    {{0.0000, 1.2387, -0.0187}, {0.0000, 1.4137, 0.0051}},   // Spine1
    {{0.0000, 1.4137, 0.0051}, {0.0000, 1.4645, 0.0259}},    // Neck
    {{0.0000, 1.4645, 0.0259}, {0.0000, 1.5146, 0.0443}},    // Neck1
    {{0.0000, 1.5146, 0.0443}, {0.0000, 1.6626, 0.0374}},    // Head
    {{0.0227, 1.3426, 0.0216}, {0.1700, 1.3199, 0.0193}},    // LeftShoulder
    {{0.1700, 1.3199, 0.0193}, {0.3314, 1.1393, 0.0201}},    // LeftArm
    {{0.3314, 1.1393, 0.0201}, {0.4533, 1.0151, 0.1833}},    // LeftForeArm
    {{0.4533, 1.0151, 0.1833}, {0.4640, 0.9994, 0.2094}},    // LeftHand
    {{0.4640, 0.9994, 0.2094}, {0.4811, 0.9745, 0.2777}},    // LeftFingerBase
    {{0.4811, 0.9745, 0.2777}, {0.4844, 0.9594, 0.2984}},    // LeftHandFinger1
    {{0.4544, 1.0075, 0.2272}, {0.4335, 0.9989, 0.2481}},    // LThumb
    {{-0.0227, 1.3426, 0.0216}, {-0.1700, 1.3199, 0.0193}},  // RightShoulder
    {{-0.1700, 1.3199, 0.0193}, {-0.3314, 1.1393, 0.0201}},  // RightArm
    {{-0.3314, 1.1393, 0.0201}, {-0.4533, 1.0151, 0.1833}},  // RightForeArm
    {{-0.4533, 1.0151, 0.1833}, {-0.4640, 0.9994, 0.2094}},  // RightHand
    {{-0.4640, 0.9994, 0.2094}, {-0.4811, 0.9745, 0.2777}},  // RightFingerBase
    {{-0.4811, 0.9745, 0.2777}, {-0.4844, 0.9594, 0.2984}},  // RightHandFinger1
    {{-0.4544, 1.0075, 0.2272}, {-0.4335, 0.9989, 0.2481}},  // RThumb
}};

// Root of the middle finger on the same mesh; the rig has no bone there.
constexpr double kMiddleKnuckle_m[3] = {0.4974, 0.9636, 0.2598};

Eigen::Vector3d Vector(const double (&xyz)[3]) { return {xyz[0], xyz[1], xyz[2]}; }

RigRest MakeRest() {
  RigRest rest;
  for (size_t b = 0; b < kRestEnds.size(); ++b) {
    rest.head_m[b] = Vector(kRestEnds[b].head);
    rest.tail_m[b] = Vector(kRestEnds[b].tail);
  }
  return rest;
}

void AnchorLimbs(const RigRest& rest, bool left, JointArray<JointAnchor>& anchors) {
  const std::string side = left ? "Left" : "Right";
  const size_t arm = RigBone(side + "Arm"), fore_arm = RigBone(side + "ForeArm");
  const size_t hand = RigBone(side + "Hand"), up_leg = RigBone(side + "UpLeg");
  const size_t leg = RigBone(side + "Leg"), foot = RigBone(side + "Foot");
  const auto head = [&](size_t bone) { return rest.head_m[bone]; };
  Eigen::Vector3d knuckle = Vector(kMiddleKnuckle_m);
  if (!left) knuckle.x() = -knuckle.x();

  const auto first = Index(left ? Joint::kShoulderLeft : Joint::kShoulderRight);
  anchors[first] = {arm, head(arm)};
  anchors[first + 1] = {fore_arm, head(fore_arm)};
  anchors[first + 2] = {hand, head(hand)};
  anchors[first + 3] = {hand, 0.5 * (head(hand) + knuckle)};
  const auto hip = Index(left ? Joint::kHipLeft : Joint::kHipRight);
  anchors[hip] = {up_leg, head(up_leg)};
  anchors[hip + 1] = {leg, head(leg)};
  anchors[hip + 2] = {foot, head(foot)};
  anchors[hip + 3] = {foot, rest.tail_m[foot]};
}

JointArray<JointAnchor> MakeAnchors() {
  const RigRest& rest = StandardRigRest();
  JointArray<JointAnchor> anchors;
  const auto middle = [&](size_t bone) -> Eigen::Vector3d {
    return 0.5 * (rest.head_m[bone] + rest.tail_m[bone]);
  };
  const size_t hips = RigBone("Hips"), spine = RigBone("Spine"), neck = RigBone("Neck");
  anchors[Joint::kHipCenter] = {hips, middle(hips)};
  anchors[Joint::kSpine] = {spine, rest.head_m[spine]};
  anchors[Joint::kShoulderCenter] = {neck, rest.head_m[neck]};
  anchors[Joint::kHead] = {RigBone("Head"), middle(RigBone("Head"))};
  AnchorLimbs(rest, true, anchors);
  AnchorLimbs(rest, false, anchors);
  return anchors;
}

}  // namespace

size_t RigBone(std::string_view name) {
  for (size_t b = 0; b < kRigBoneCount; ++b) {
    if (kRigBoneNames[b] == name) return b;
  }
  throw std::logic_error("the rig has no bone " + std::string(name));
}

const RigRest& StandardRigRest() {
  static const RigRest rest = MakeRest();
  return rest;
}

const JointArray<JointAnchor>& StandardJointAnchors() {
  static const JointArray<JointAnchor> anchors = MakeAnchors();
  return anchors;
}

std::array<Eigen::Vector3d, kRigBoneCount> StandardBoneHeads(const RigPose& pose) {
  const RigRest& rest = StandardRigRest();
  std::array<Eigen::Vector3d, kRigBoneCount> heads;
  heads[0] = pose.root_m;
  for (size_t b = 1; b < heads.size(); ++b) {
    const auto parent = static_cast<size_t>(kRigBoneParent[b]);
    heads[b] =
        heads[parent] + pose.world_from_rest[parent] * (rest.head_m[b] - rest.head_m[parent]);
  }
  return heads;
}

Posture StandardPosture(const RigPose& pose) {
  const auto heads = StandardBoneHeads(pose);
  const auto& anchors = StandardJointAnchors();
  const RigRest& rest = StandardRigRest();
  Posture posture;
  for (size_t j = 0; j < anchors.size(); ++j) {
    const size_t bone = anchors[j].bone;
    posture.position_m[j] =
        heads[bone] + pose.world_from_rest[bone] * (anchors[j].rest_m - rest.head_m[bone]);
  }
  return posture;
}

const JointOrientations& StandardOrientations() {
  static const JointOrientations rest = ComputeOrientations(StandardPosture(RigPose{}));
  return rest;
}

// The bone that ends in joint j rotates with the rig bone that carries its parent joint.
JointOrientations ComputeOrientations(const RigPose& pose) {
  const auto& anchors = StandardJointAnchors();
  JointOrientations out;
  for (size_t j = 0; j < kJointCount; ++j) {
    const size_t bone = anchors[ParentOf(j)].bone;
    out[j] = (pose.world_from_rest[bone] * StandardOrientations()[j]).normalized();
  }
  return out;
}

Eigen::Quaterniond EstimateHeading(const RigPose& pose) {
  // The pelvis' left axis stays level when a person bends or sits, its forward axis does not. Only
  // when a body lies on its side is it the reverse.
  const Eigen::Vector3d left = pose.world_from_rest[0] * Eigen::Vector3d::UnitX();
  Eigen::Vector3d forward(-left.z(), 0.0, left.x());
  if (forward.norm() < 0.5) forward = pose.world_from_rest[0] * Eigen::Vector3d::UnitZ();
  return Eigen::Quaterniond(
      Eigen::AngleAxisd(std::atan2(forward.x(), forward.z()), Eigen::Vector3d::UnitY()));
}

RigPose WithoutHeading(const RigPose& pose) {
  const Eigen::Quaterniond unturn = EstimateHeading(pose).conjugate();
  RigPose out = pose;
  out.root_m = Eigen::Vector3d(0.0, pose.root_m.y(), 0.0);
  for (auto& rotation : out.world_from_rest) rotation = unturn * rotation;
  return out;
}

}  // namespace ossa::recon
