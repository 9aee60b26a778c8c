#pragma once
#include <cstdint>

#include "recon/skeleton_sequence.h"

namespace ossa::tools {

/// Counts of impossible motion in recordings without truth. One count is one joint (or bone, or
/// pair of hands) in one frame.
struct GrossFailures {
  int64_t frames = 0;
  int64_t jumps = 0;        // a joint left its parent's side by 25 cm since the frame before
  int64_t snaps = 0;        // a hand fell onto the other: 25 cm apart before, 10 cm now
  int64_t wrong_bones = 0;  // a bone 40 % off its median over the recording
  int64_t noticed = 0;  // jumps and snaps with a joint of reliability below one half, in the frame
                        // they lead to or the one they come from: one of the two is wrong
  int64_t joints = 0;   // evaluated
  int64_t doubted = 0;  // of those: with a reliability below one half
  double jitter_cm = 0.0;  // mean length of second differences, over all joints and frames

  GrossFailures& operator+=(const GrossFailures& other);
};

/// Failures of `sequence`. `judged`: the same frames with reliabilities (a method's output), which
/// decide whether a failure was noticed. `recording`: the sensor's skeletons, from which the median
/// bone lengths are taken. Joints that are absent or not tracked do not count. Frames more than 0.1
/// s apart are not compared.
GrossFailures CountGrossFailures(const recon::SkeletonSequence& sequence,
                                 const recon::SkeletonSequence& judged,
                                 const recon::SkeletonSequence& recording);

}  // namespace ossa::tools
