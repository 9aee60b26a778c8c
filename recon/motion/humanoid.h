#pragma once
#include <array>
#include <cstddef>
#include <string_view>

#include "recon/skeleton.h"

namespace ossa::recon {

/// The humanoid bones that a depth image can show, parents before children, in the form that avatar
/// tools expect: each rotates about its start, and branches share a common parent.
enum class HumanBone {
  kHips,
  kSpine,
  kChest,
  kNeck,
  kHead,
  kLeftShoulder,
  kLeftUpperArm,
  kLeftLowerArm,
  kLeftHand,
  kRightShoulder,
  kRightUpperArm,
  kRightLowerArm,
  kRightHand,
  kLeftUpperLeg,
  kLeftLowerLeg,
  kLeftFoot,
  kLeftToes,
  kRightUpperLeg,
  kRightLowerLeg,
  kRightFoot,
  kRightToes,
};
inline constexpr size_t kHumanBoneCount = 21;  // by definition, of those above

/// A bone's names, parent (-1: none), the joint where it starts, and the end joint of our bone that
/// drives it. If both joints are equal, no bone of ours drives it: it follows its parent.
struct HumanBoneInfo {
  std::string_view unity;   // HumanBodyBones
  std::string_view vrm;     // VRM 1.0
  std::string_view mixamo;  // without prefix; also CMU's name
  int parent = 0;
  Joint place{};
  Joint turner{};
};
extern const std::array<HumanBoneInfo, kHumanBoneCount> kHumanBones;

/// Index of a bone in an array of all bones.
constexpr size_t Index(HumanBone bone) { return static_cast<size_t>(bone); }

}  // namespace ossa::recon
