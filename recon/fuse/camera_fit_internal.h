#pragma once
#include <Eigen/Geometry>
#include <optional>
#include <vector>

#include "recon/fuse/clock_search_internal.h"
#include "recon/fuse/joint_track_internal.h"
#include "recon/skeleton_sequence.h"

namespace ossa::recon {

/// A joint that both cameras track at the same time, in each camera's own space, metres.
struct CommonJoint {
  Eigen::Vector3d in_camera_0 = Eigen::Vector3d::Zero(), in_other = Eigen::Vector3d::Zero();
  double weight = 0.0;  // the smaller of both confidences
  size_t track = 0;     // of camera 0
  size_t joint = 0;
};

/// The correspondences under one guess of the other camera's pose.
struct CommonJoints {
  std::vector<CommonJoint> joints;
  double possible = 0.0;  // total weight if every body had a counterpart
  double common_s = 0.0;  // time in which both cameras see people, seconds
};

/// The data of two cameras: body tracks, compared times, and the mean unit normals of their floors.
struct CameraPair {
  std::vector<JointTrack> camera_0, other;
  std::vector<double> moments_s;  // camera 0's clock
  double length_s = 0.0;          // duration of camera 0's recording
  std::optional<Eigen::Vector3d> floor_0, other_floor;
};

CameraPair MakeCameraPair(const SkeletonSequence& camera_0, const SkeletonSequence& other);

/// The joints of bodies that coincide under the guess.
CommonJoints FindCommonJoints(const CameraPair& pair, const CameraGuess& guess);

/// Matched share of the possible weight, [0, 1), reduced for a short common time.
double ScoreGuess(const CommonJoints& common, const CameraGuess& guess);

/// Refines transform and clock offset by local search; `step_s` is the frame time. The cost is the
/// mean squared joint distance, truncated at 15 cm.
CameraGuess RefineGuess(const CameraPair& pair, const CameraGuess& guess, double step_s);

/// Root mean square deviation of camera 0's joints from their mean positions, metres.
double MeasureMotion_m(const CommonJoints& common);

/// Median distance of common joints under the guess, metres.
double MedianDistance_m(const CommonJoints& common, const CameraGuess& guess);

}  // namespace ossa::recon
