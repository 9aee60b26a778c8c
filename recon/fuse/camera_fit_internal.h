#pragma once
#include <Eigen/Geometry>
#include <optional>
#include <vector>

#include "recon/fuse/clock_search_internal.h"
#include "recon/fuse/joint_track_internal.h"
#include "recon/skeleton_sequence.h"

namespace ossa::recon {

/// One joint that both cameras track at one time, in each camera's own space, metres.
struct CommonJoint {
  Eigen::Vector3d in_camera_0, in_other;
  double weight = 0.0;  // the lesser confidence
  size_t track = 0;     // of camera 0
  size_t joint = 0;
};

/// What both cameras see under one guess of where the other is.
struct CommonJoints {
  std::vector<CommonJoint> joints;
  double possible = 0.0;  // weight, had everybody in both been found to be somebody of the other
  double common_s = 0.0;  // time in which both see somebody, seconds
};

/// What is known of two cameras: their bodies' tracks, the moments that are compared, and the mean
/// unit normals of their floors.
struct CameraPair {
  std::vector<JointTrack> camera_0, other;
  std::vector<double> moments_s;  // camera 0's clock
  double length_s = 0.0;          // of camera 0's recording
  std::optional<Eigen::Vector3d> floor_0, other_floor;
};

CameraPair MakeCameraPair(const SkeletonSequence& camera_0, const SkeletonSequence& other);

/// The joints of bodies that lie on each other under the guess.
CommonJoints FindCommonJoints(const CameraPair& pair, const CameraGuess& guess);

/// Share of what could agree that does, [0, 1), less where the common time is short.
double ScoreGuess(const CommonJoints& common, const CameraGuess& guess);

/// Better transform and clock offset near the guess; `step_s` is a frame's time. The cost is the
/// mean square distance of joints, none counted as more than 15 cm.
CameraGuess RefineGuess(const CameraPair& pair, const CameraGuess& guess, double step_s);

/// Root mean square of how far each joint of camera 0 is from its own mean place, metres.
double MeasureMotion_m(const CommonJoints& common);

/// Median distance of common joints under the guess, metres.
double MedianDistance_m(const CommonJoints& common, const CameraGuess& guess);

}  // namespace ossa::recon
