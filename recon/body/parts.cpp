#include "recon/body/parts.h"

#include <array>
#include <cmath>

#include "recon/body/body_build_internal.h"

namespace ossa::recon {
namespace {

// Labels of the person's left side; kMirroredPart gives the right ones.
enum LeftPart : uint8_t {
  kUpperHead = 1,
  kLowerHead = 3,
  kNeck = 5,
  kShoulder = 6,
  kUpperArm = 8,
  kLowerArm = 10,
  kElbow = 12,
  kWrist = 14,
  kHand = 16,
  kUpperTorso = 18,
  kLowerTorso = 20,
  kUpperLeg = 22,
  kLowerLeg = 24,
  kKnee = 26,
  kAnkle = 28,
  kFoot = 30,
};

// Bones of the left side in the rig's order.
enum Bone : size_t {
  kHips = 0,
  kUpLeg = 2,
  kLeg = 3,
  kFootBone = 4,
  kToe = 5,
  kSpine = 12,
  kNeckBone = 14,
  kNeck1 = 15,
  kHeadBone = 16,
  kCollar = 17,
  kArm = 18,
  kForeArm = 19,
  kHandBone = 20,
  kFingerBase = 21,
  kFinger = 22,
  kThumb = 23,
};
// Constants: numbers of the rig's bones (MPFB's format).

constexpr size_t kRightLegOffset = 5;  // from a left leg bone to the right one
constexpr size_t kRightArmOffset = 7;

// Half widths of the bands around the joints and other borders, decimetres on the neutral body
// (1.67 m). As in Shotton et al. 2011, fig. 2: joints get small patches of their own, so that the
// mode of a patch localises the joint.
constexpr float kShoulderReach_dm = 0.85f;  // along the upper arm, and around the joint
constexpr float kElbowHalf_dm = 0.45f;
constexpr float kWristBefore_dm = 0.40f;
constexpr float kWristAfter_dm = 0.20f;
constexpr float kKneeHalf_dm = 0.65f;
constexpr float kAnkleAbove_dm = 0.55f;
constexpr float kAnkleReach_dm = 0.75f;  // heel and instep farther from the joint are foot
constexpr float kEyeLine_dm = 7.30f;     // upper and lower head meet just below the eyes' height

float Along(const Eigen::Vector3f& p, const Eigen::Vector3f& from, const Eigen::Vector3f& to) {
  return (p - from).dot((to - from).normalized());
}

uint8_t ArmPart(const Eigen::Vector3f& p, const PartLandmarks& marks, size_t side) {
  const auto& shoulder = marks.bone_head_dm[kArm + side];
  const auto& elbow = marks.bone_head_dm[kForeArm + side];
  const auto& wrist = marks.bone_head_dm[kHandBone + side];
  const float upper_dm = Along(p, shoulder, elbow);
  const float lower_dm = Along(p, elbow, wrist);
  const float forearm_dm = (wrist - elbow).norm();
  if (lower_dm > forearm_dm + kWristAfter_dm) return kHand;
  if (lower_dm > forearm_dm - kWristBefore_dm) return kWrist;
  // Upper arm and forearm meet at an angle: the plane through the elbow halves it.
  const float from_elbow_dm = (p - elbow).dot(
      ((wrist - elbow).normalized() + (elbow - shoulder).normalized()).normalized());
  if (from_elbow_dm > kElbowHalf_dm) return kLowerArm;
  if (from_elbow_dm > -kElbowHalf_dm) return kElbow;
  return upper_dm > kShoulderReach_dm ? kUpperArm : kShoulder;
}

uint8_t LegPart(const Eigen::Vector3f& p, const PartLandmarks& marks, size_t side) {
  const auto& hip = marks.bone_head_dm[kUpLeg + side];
  const auto& knee = marks.bone_head_dm[kLeg + side];
  const auto& ankle = marks.bone_head_dm[kFootBone + side];
  const float from_ankle_dm = Along(p, ankle, knee);
  if (from_ankle_dm < kAnkleAbove_dm) {
    return (p - ankle).norm() < kAnkleReach_dm ? kAnkle : kFoot;
  }
  const float from_knee_dm = Along(p, knee, ankle);
  if (from_knee_dm > kKneeHalf_dm) return kLowerLeg;
  return Along(p, knee, hip) > kKneeHalf_dm ? kUpperLeg : kKnee;
}

float SumWeights(const PartLabelInput& place, std::initializer_list<size_t> bones, size_t side) {
  float sum = 0;
  for (const size_t bone : bones) sum += place.bone_weight[bone + side];
  return sum;
}

uint8_t LabelLeftPart(const PartLabelInput& place, const PartLandmarks& marks, bool left) {
  const Eigen::Vector3f& p = place.centroid_dm;
  const size_t arm_side = left ? 0 : kRightArmOffset;
  const size_t leg_side = left ? 0 : kRightLegOffset;
  const float arm =
      SumWeights(place, {kArm, kForeArm, kHandBone, kFingerBase, kFinger, kThumb}, arm_side);
  const float collar = place.bone_weight[kCollar + arm_side];
  // Skirt vertices are weighted to both legs.
  const float leg = SumWeights(place, {kUpLeg, kLeg, kFootBone, kToe}, 0) +
                    SumWeights(place, {kUpLeg, kLeg, kFootBone, kToe}, kRightLegOffset);
  const float head = place.bone_weight[kHeadBone];
  const float neck = place.bone_weight[kNeckBone] + place.bone_weight[kNeck1];
  const float torso = 1.0f - arm - collar - leg - head - neck;
  if (arm > 0.5f) return ArmPart(p, marks, arm_side);
  if (leg > 0.5f) return LegPart(p, marks, leg_side);
  if ((p - marks.bone_head_dm[kArm + arm_side]).norm() < kShoulderReach_dm) return kShoulder;
  if (head > std::max(neck, torso)) return p.y() > kEyeLine_dm ? kUpperHead : kLowerHead;
  if (neck > torso + collar) return kNeck;
  return p.y() > marks.bone_head_dm[kSpine].y() ? kUpperTorso : kLowerTorso;
}

}  // namespace

uint8_t LabelPart(const PartLabelInput& place, const PartLandmarks& landmarks) {
  const bool left = place.centroid_dm.x() >= 0;
  const uint8_t part = LabelLeftPart(place, landmarks, left);
  return left ? part : kMirroredPart[part];
}

Rgb PartColour(int label) {
  // Left parts have warm colours, right parts cold ones; joint patches are lighter than the limbs
  // between them.
  static constexpr std::array<Rgb, kLabelCount> kColours = {{
      {0, 0, 0},                                                           // background
      {255, 90, 60},   {60, 120, 255},  {200, 50, 90},   {40, 70, 170},    // head
      {240, 240, 120},                                                     // neck
      {255, 200, 160}, {160, 220, 255},                                    // shoulders
      {230, 120, 20},  {20, 150, 220},  {190, 80, 10},   {10, 100, 180},   // arms
      {255, 230, 60},  {110, 255, 240}, {255, 160, 220}, {180, 160, 255},  // elbows, wrists
      {255, 40, 170},  {110, 50, 255},                                     // hands
      {220, 60, 60},   {50, 170, 110},  {150, 30, 30},   {20, 110, 60},    // torso
      {240, 150, 90},  {90, 200, 150},  {180, 110, 60},  {60, 140, 130},   // legs
      {255, 255, 150}, {190, 255, 190}, {255, 190, 110}, {150, 240, 170},  // knees, ankles
      {200, 160, 30},  {30, 180, 60},                                      // feet
      {140, 140, 140}                                                      // other
  }};
  return label >= 0 && label < kLabelCount ? kColours[static_cast<size_t>(label)] : Rgb{};
}

}  // namespace ossa::recon
