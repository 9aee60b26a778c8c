#include "tools/synth/sequence_poses.h"

#include <algorithm>

#include "depth/base/random.h"
#include "recon/body/standard_body.h"

namespace ossa::tools {
namespace {

// Extent of the hips' path that keeps a person in view; by hand
constexpr double kRoomToMove_m = 1.2;

struct Extent {
  Eigen::Vector3d low, high;
  double size_m() const { return std::max(high.x() - low.x(), high.z() - low.z()); }
};

Extent MeasureExtent(const recon::MotionClip& clip, size_t count) {
  Extent extent{clip.frames[0].root_m, clip.frames[0].root_m};
  for (size_t i = 0; i < count; ++i) {
    extent.low = extent.low.cwiseMin(clip.frames[i].root_m);
    extent.high = extent.high.cwiseMax(clip.frames[i].root_m);
  }
  return extent;
}

}  // namespace

std::vector<recon::RigPose> SequencePoses(const std::vector<recon::MotionClip>& clips,
                                          int64_t frames, uint64_t seed) {
  std::vector<const recon::MotionClip*> fitting;
  const recon::MotionClip* best = nullptr;  // the longest, if none fits
  for (const auto& clip : clips) {
    if (clip.frames.empty()) continue;
    if (best == nullptr || clip.frames.size() > best->frames.size()) best = &clip;
    const auto count = static_cast<size_t>(frames);
    if (clip.frames.size() >= count && MeasureExtent(clip, count).size_m() < kRoomToMove_m) {
      fitting.push_back(&clip);
    }
  }
  if (best == nullptr) return {};
  Random random(seed, 77);
  const recon::MotionClip& clip = fitting.empty() ? *best : *fitting[random.Index(fitting.size())];
  const size_t count = std::min(clip.frames.size(), static_cast<size_t>(frames));
  const Extent extent = MeasureExtent(clip, count);
  const Eigen::Quaterniond unturn = recon::EstimateHeading(clip.frames[0]).conjugate();
  Eigen::Vector3d middle = 0.5 * (extent.low + extent.high);
  middle.y() = 0;
  std::vector<recon::RigPose> poses(clip.frames.begin(),
                                    clip.frames.begin() + static_cast<ptrdiff_t>(count));
  for (auto& pose : poses) {
    pose.root_m = unturn * (pose.root_m - middle);
    for (auto& rotation : pose.world_from_rest) rotation = unturn * rotation;
  }
  return poses;
}

}  // namespace ossa::tools
