#pragma once
#include <Eigen/Core>
#include <limits>
#include <optional>
#include <vector>

#include "tools/people/body_measures.h"

namespace ossa::people {

/// Positions of the 20 joints, in SDK order, where they are seen: camera space, metres.
using Keypoints = std::vector<std::optional<Eigen::Vector3f>>;

/// A person tracked over frames: confirmed, i.e. seen in the last frame, or lost.
struct Track {
  int id = 0;  // 1 to 255

  // Last observation.
  double last_seen_s = 0;
  std::vector<int> cells;  // of the grid, ascending; empty some time after the loss
  std::vector<float> z_m;  // depth of those cells
  Eigen::Vector3f mean_m =
      Eigen::Vector3f::Zero();  // centroid of the visible surface; if occluded, as predicted
  Keypoints keypoints_m;
  bool lost_behind = false;  // when last seen, it was at the silhouette of a nearer person

  // Motion.
  Eigen::Vector3f velocity_m_s = Eigen::Vector3f::Zero();
  int velocity_frames = 0;                                 // number of frames in the velocity
  Eigen::Vector3f first_mean_m = Eigen::Vector3f::Zero();  // when it was first seen
  float first_m2 = 0;
  bool moved = false;                                     // since then
  Eigen::Vector3f rest_mean_m = Eigen::Vector3f::Zero();  // at its last movement
  float rest_m2 = 0;
  double moved_s = 0;    // time of the last movement
  bool entered = false;  // most of it once was foreground: the person entered a known scene

  // The body.
  float full_m2 = 0;  // largest recent visible surface
  BodyMeasures measures;

  // Classification.
  std::optional<double> score;  // probability of being a person: weighted mean over the frames
  int age = 0;                  // detections
  std::vector<float> facing;    // posterior of the model's contexts (forest::Classification)
  double facing_s = -std::numeric_limits<double>::infinity();  // time of `facing`
  // Until this time it counts as a person for sure, whatever it scores.
  double certain_until_s = -std::numeric_limits<double>::infinity();
  // Last time that it was on the floor for sure, in front of the room.
  double lay_s = -std::numeric_limits<double>::infinity();
};

/// A track's predicted centroid: with constant velocity for at most `max_prediction_s`.
Eigen::Vector3f PredictMean_m(const Track& track, double time_s, double max_prediction_s);

}  // namespace ossa::people
