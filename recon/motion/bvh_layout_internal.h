#pragma once
#include <array>
#include <limits>
#include <string>
#include <vector>

#include "recon/motion/bvh.h"

namespace ossa::recon {

inline constexpr double kBvhCentimetres = 100.0;  // per metre; the unit most programs expect of BVH
inline constexpr double kBvhEnd_cm = 5.0;         // length of end sites; by hand
inline constexpr size_t kNoBvhJoint = std::numeric_limits<size_t>::max();

/// The file joints that rotate each bone (bone j ends in joint j) and lie at its end.
struct BvhLayout {
  std::vector<BvhJoint> joints;
  JointArray<size_t> place{};   // file joint at SDK joint j, moved by its bone; or none
  JointArray<size_t> turner{};  // file joint that rotates the bone ending in j; 0: the root
};

/// The rotation channels of a joint.
inline std::vector<BvhChannel> BvhTurns() {
  return {BvhChannel::kZrotation, BvhChannel::kXrotation, BvhChannel::kYrotation};
}

struct HumanBoneInfo;
/// The bone's name in a naming scheme; for kSdk, which has none, VRM's.
std::string HumanBoneName(const HumanBoneInfo& bone, BvhNames names);

/// The 21 joints of a humanoid in a naming scheme. `hip_offsets_m`: of left and right thigh from
/// the hips, in the hip frame.
BvhLayout HumanoidLayout(BvhNames names, const BoneLengths& lengths,
                         const std::array<Eigen::Vector3d, 2>& hip_offsets_m);

}  // namespace ossa::recon
