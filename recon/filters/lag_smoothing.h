#pragma once
#include <span>

#include "recon/skeleton_sequence.h"

// Constants: widths are chosen on UI-PRMD by `ossa experiment sdk`, data = ["correct", "lag"],
// which chooses them anew for each person on the other people.

namespace ossa::recon {

/// Frames of lag of who has the whole recording: as many as the Gaussian is wide.
inline constexpr int kWholeRecording = -1;

/// How a joint's way is smoothed where frames after it are known. A Gaussian over as many frames
/// before as after (zero phase): what moves steadily stays where it is.
struct LagOptions {
  int frames = 2;         // of lag, >= 0, or kWholeRecording; 0 leaves everything as it is
  double sigma_s = 0.08;  // of the Gaussian, > 0
  /// Two frames whose middle (the line between them, at the frame's time) is farther than this from
  /// where the joint is say little of it, > 0: a jump, a turning point of a fast move.
  double alike_m = 0.05;
  bool keeps_bones = false;  // bones keep the lengths that they have in each frame

  /// So many frames, up to 2, or the whole recording, with the widths above, which were chosen for
  /// all of them (docs/benchmarks/reconstruction.md).
  static LagOptions Of(int frames, bool keeps_bones);
};

/// One person at one time.
struct TimedPosture {
  double time_s = 0.0;
  Posture posture;             // camera space
  JointArray<bool> present{};  // joints that are anywhere
  JointOrientations orientation;
};

/// The posture `at` of a person's way, times rising, smoothed by those around it; of frames at one
/// time the nearest. A joint's frames end where it is absent, and where the person was away for
/// longer than a quarter of a second.
TimedPosture SmoothedAt(std::span<const TimedPosture> way, size_t at, const LagOptions& options);

/// The whole recording so, every person by itself. States, confidences and whatever else a joint
/// has stay.
SkeletonSequence SmoothSequence(const SkeletonSequence& sequence, const LagOptions& options);

}  // namespace ossa::recon
