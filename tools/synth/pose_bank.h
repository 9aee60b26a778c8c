#pragma once
#include <optional>
#include <string_view>
#include <vector>

#include "depth/base/random.h"
#include "recon/body/rig.h"

namespace ossa::tools {

// Constants: chosen by hand, where nothing else is said.

struct PoseBankOptions {
  /// A frame is redundant when no joint moved farther than this since the last frame kept.
  double least_distance_m = 0.05;
  /// Poses alike (all joints in the same cells of this size) are kept at most so often.
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

/// How often poses are had.
enum class Poses {
  kSpread,   // what people do seldom nearly as often as what they do all the time
  kNatural,  // as often as people take them: a pose is as likely as another of the clips
  kAny,      // as spread; one in four frames any posture that joints can take
};
std::optional<Poses> PosesFromName(std::string_view name);
PoseBankOptions MakeBankOptions(Poses poses);
PoseVariation MakeVariation(Poses poses);

/// The pose seen in a mirror: left and right change places.
recon::RigPose Mirrored(const recon::RigPose& pose);

/// A pose like the given one, as another person would take it.
recon::RigPose Varied(const recon::RigPose& pose, const PoseVariation& variation, Random& random);

/// One arm anywhere it can go, 0 left and 1 right: in the half space outside of the trunk and
/// before it.
void RandomArm(size_t side, recon::RigPose* pose, Random& random);

/// The pose turned about the vertical through the origin.
recon::RigPose Turned(const recon::RigPose& pose, double angle_rad);

}  // namespace ossa::tools
