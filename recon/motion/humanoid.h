#pragma once
#include <array>
#include <cstddef>
#include <string_view>

#include "recon/skeleton.h"

namespace ossa::recon {

/// The bones of a humanoid that a depth image tells of, parents before children, as tools for
/// avatars expect them: each turns about where it begins, branches hang from their common parent.
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

/// What is known of a bone: its names, its parent (-1: none), the joint that it begins in, and the
/// joint that ends the bone of ours which turns it. Where the two are one, no bone of ours follows:
/// it is carried along.
struct HumanBoneInfo {
  std::string_view unity;   // HumanBodyBones
  std::string_view vrm;     // VRM 1.0
  std::string_view mixamo;  // without its prefix; CMU's name
  int parent;
  Joint place;
  Joint turner;
};
extern const std::array<HumanBoneInfo, kHumanBoneCount> kHumanBones;

/// Place of a bone in an array of all.
constexpr size_t Index(HumanBone bone) { return static_cast<size_t>(bone); }

}  // namespace ossa::recon
