#pragma once
#include <optional>
#include <string_view>
#include <vector>

#include "depth/base/random.h"
#include "recon/body/rig.h"

namespace ossa::tools {

// Constants: chosen by hand unless stated otherwise.

struct PoseBankOptions {
  /// A frame is redundant if no joint moved farther than this since the last frame kept.
  double least_distance_m = 0.05;
  /// Poses are similar if all joints lie in the same cells of this size; at most `most_alike`
  /// similar poses are kept.
  double cell_m = 0.18;
  int most_alike = 6;
};

/// The poses of many clips without the redundant ones, heading removed: facing +z over the origin.
std::vector<recon::RigPose> MakePoseBank(const std::vector<recon::MotionClip>& clips,
                                         const PoseBankOptions& options = {});

struct PoseVariation {
  double mirror_share = 0.5;
  double random_arm_share = 0.25;     // of frames: one or both arms anywhere within their limits
  double perturbation_rad = 0.08;     // of each limb, standard deviation
  double wrist_rad = 0.35;            // of the hand against the forearm, which mocap lacks
  double random_posture_share = 0.0;  // of frames: all joints anywhere within their limits
};

/// Distribution of the poses.
enum class Poses {
  kSpread,   // rare poses nearly as often as frequent ones
  kNatural,  // all frames of the clips are equally likely
  kAny,      // as kSpread; one frame in four has a random posture within the joint limits
};
std::optional<Poses> PosesFromName(std::string_view name);
PoseBankOptions MakeBankOptions(Poses poses);
PoseVariation MakeVariation(Poses poses);

/// The mirrored pose: left and right are exchanged.
recon::RigPose Mirrored(const recon::RigPose& pose);

/// A random variation of the pose.
recon::RigPose Varied(const recon::RigPose& pose, const PoseVariation& variation, Random& random);

/// Moves one arm (0 left, 1 right) to a random place within its joint limits, in the half space
/// beside and in front of the trunk.
void RandomArm(size_t side, recon::RigPose* pose, Random& random);

/// The pose rotated about the vertical through the origin.
recon::RigPose Turned(const recon::RigPose& pose, double angle_rad);

}  // namespace ossa::tools
