#pragma once
#include <Eigen/Core>
#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "depth/image/depth_frame.h"
#include "recon/skeleton.h"

namespace ossa::tools {

/// True position of one joint in a real frame: a point in camera space, or, for a mark by eye, its
/// line of sight, compared at the depth of the evaluated joint.
struct RealTruth {
  std::optional<Eigen::Vector3d> position_m;  // camera space
  std::optional<Eigen::Vector2d> pixel;       // (u, v)
};

/// One still with the true position of each joint of the set.
struct RealStill {
  std::string name;
  depth::DepthFrame frame;
  std::vector<RealTruth> truth{};  // one entry per joint of the set; both empty: nothing is known
  /// Estimates of the same joints by another method, if the set has them.
  std::vector<std::optional<Eigen::Vector3d>> peer_m{};
};

/// Stills of one kind, evaluated together.
struct RealSet {
  std::string name;
  std::string peer{};                      // whose estimates peer_m are; "" = nobody's
  std::vector<recon::Joint> joints{};      // that are evaluated
  std::vector<std::string> joint_names{};  // as the set calls them
  std::vector<RealStill> stills{};
  /// True: constant offsets come from the other half of the stills (even or odd); false, for small
  /// sets: from all stills.
  bool offsets_from_other_half = true;
};

/// A recording without truth: frames in order of time.
struct RealVideo {
  std::string name;
  std::vector<depth::DepthFrame> frames;
  bool stills = false;  // the frames are independent
};

/// Sets with truth below SHARED/real: depth_frames/FOLDER with marks (marks.txt beside the images,
/// else ossa's own marks of skeltrack_v1), itop_depth from the side and from the ceiling. Missing
/// sets are left out; damaged ones throw InputError. At most `most` stills of each set, evenly
/// spaced; 0 = all.
std::vector<RealSet> ReadRealSets(const std::filesystem::path& shared, int most);

/// Everything else below SHARED/real that has depth images: kinect_v1_seated_video, other folders
/// of depth_frames, recordings (.oni and .mkv). At most the first `most` frames of each; 0 = all.
std::vector<RealVideo> ReadRealVideos(const std::filesystem::path& shared, int most);

}  // namespace ossa::tools
