#pragma once
#include <span>

#include "recon/skeleton_sequence.h"

// Constants: widths are chosen on UI-PRMD by `ossa experiment sdk`, data = ["correct", "lag"],
// which cross-validates them over people.

namespace ossa::recon {

/// Lag when the whole recording is available: as many frames as the Gaussian is wide.
inline constexpr int kWholeRecording = -1;

/// Smoothing of joints when later frames are known: a Gaussian over equally many earlier and later
/// frames (zero phase). Steady motion is unchanged.
struct LagOptions {
  int frames = 2;         // lag, >= 0, or kWholeRecording; 0 changes nothing
  double sigma_s = 0.08;  // standard deviation of the Gaussian, > 0
  /// A pair of frames whose interpolated position is farther than this from the joint gets little
  /// weight, > 0: there is a jump or a turning point of a fast movement.
  double alike_m = 0.05;
  bool keeps_bones = false;  // keep the bone lengths of each frame

  /// Options for a lag of up to 2 frames, or the whole recording, with the widths above, which were
  /// chosen for all of them (docs/benchmarks/reconstruction.md).
  static LagOptions Of(int frames, bool keeps_bones);
};

/// One person at one time.
struct TimedPosture {
  double time_s = 0.0;
  Posture posture;             // camera space
  JointArray<bool> present{};  // joints that have a position
  JointOrientations orientation;
};

/// Posture number `at` of a person's track (times ascending), smoothed by its neighbours; of frames
/// with equal times the nearest is used. Smoothing stops at frames without the joint, and at
/// absences of the person of more than a quarter of a second.
TimedPosture SmoothedAt(std::span<const TimedPosture> track, size_t at, const LagOptions& options);

/// Smooths a whole recording, person by person. States, confidences and all other joint data are
/// unchanged.
SkeletonSequence SmoothSequence(const SkeletonSequence& sequence, const LagOptions& options);

}  // namespace ossa::recon
