#pragma once
#include <vector>

#include "recon/skeleton_sequence.h"

namespace ossa::tools {

/// Input for the detection of absent frames.
struct FramesDue {
  std::vector<double> truth_s;  // times of the truth's frames, in order
  double longest_gap_s = 0.2;   // between two of them nothing is known of the truth beyond that
  bool same_clock = true;       // truth and result began together: also the ends are due
};

/// Inserts frames without bodies where `frames` (increasing times) lacks frames that were expected:
/// otherwise a tracker that writes nothing for hard frames would seem to miss nothing. Frames are
/// expected wherever the truth is known, at the result's frame interval (the lower quartile of its
/// time steps, since gaps only lengthen steps). A result that shares no time with the truth stays
/// unchanged.
void AddAbsentFrames(const FramesDue& due, std::vector<recon::SkeletonFrame>* frames);

}  // namespace ossa::tools
