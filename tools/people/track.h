#pragma once
#include <Eigen/Core>
#include <optional>
#include <vector>

#include "tools/people/body_measures.h"

namespace ossa::people {

/// Places on a body that are told from each other in every frame, in a fixed order (the 20 joints
/// in SDK order): where they are seen, camera space, metres.
using Keypoints = std::vector<std::optional<Eigen::Vector3f>>;

/// A person followed from frame to frame: confirmed, i.e. seen in the last frame, or lost.
struct Track {
  int id = 0;  // 1 to 255

  // As seen last.
  double last_seen_s = 0;
  std::vector<int> cells;  // of the grid, ascending; empty a while after it was lost
  std::vector<float> z_m;  // depth of those cells
  Eigen::Vector3f mean_m = Eigen::Vector3f::Zero();  // of the surface; of who is hidden: expected
  Keypoints keypoints_m;
  bool lost_behind = false;  // when last seen, it was at the silhouette of somebody nearer

  // Motion.
  Eigen::Vector3f velocity_m_s = Eigen::Vector3f::Zero();
  int velocity_frames = 0;                                 // that the velocity is of
  Eigen::Vector3f first_mean_m = Eigen::Vector3f::Zero();  // when it was new: its middle
  float first_m2 = 0;                                      // and surface
  bool moved = false;                                      // since then
  Eigen::Vector3f rest_mean_m = Eigen::Vector3f::Zero();   // the same when it moved last
  float rest_m2 = 0;
  double moved_s = 0;    // when it moved last
  bool entered = false;  // most of it once was foreground: it came into a known room

  // The body.
  float full_m2 = 0;  // the most surface seen of it lately
  BodyMeasures measures;

  // What the forest saw.
  std::optional<double> score;  // that it is a person: mean of the last seconds
  int age = 0;                  // detections
  std::vector<float> facing;    // posterior of the model's contexts (forest::Classification)
  double facing_s = -1e9;       // when
};

/// Where a track's middle is expected: it goes on as before for at most `max_prediction_s`.
Eigen::Vector3f PredictMean_m(const Track& track, double time_s, double max_prediction_s);

}  // namespace ossa::people
