#pragma once
#include <array>
#include <limits>
#include <string>
#include <vector>

#include "recon/motion/bvh.h"

namespace ossa::recon {

inline constexpr double kBvhCentimetres =
    100.0;                                 // of a metre; the unit most programs expect of BVH
inline constexpr double kBvhEnd_cm = 5.0;  // an end site's distance; by hand
inline constexpr size_t kNoBvhJoint = std::numeric_limits<size_t>::max();

/// Which joint of the file turns each bone (bone j ends in joint j), and which lies at its end.
struct BvhLayout {
  std::vector<BvhJoint> joints;
  JointArray<size_t> place{};   // file joint at SDK joint j, carried along by the bone; or none
  JointArray<size_t> turner{};  // file joint that turns the bone ending in j; 0: the root does
};

/// Channels of a joint that turns.
inline std::vector<BvhChannel> BvhTurns() {
  return {BvhChannel::kZrotation, BvhChannel::kXrotation, BvhChannel::kYrotation};
}

struct HumanBoneInfo;
/// The bone's name; of kSdk, which has none, VRM's.
std::string HumanBoneName(const HumanBoneInfo& bone, BvhNames names);

/// The 21 joints of a humanoid by these names. `hip_offsets_m`: of left and right thigh from the
/// hips, in the hips' frame.
BvhLayout HumanoidLayout(BvhNames names, const BoneLengths& lengths,
                         const std::array<Eigen::Vector3d, 2>& hip_offsets_m);

}  // namespace ossa::recon
