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

/// Puts a frame without bodies wherever `frames` (times increase) has none though one was due: else
/// a tracker that writes nothing where it is hard would seem to miss nothing. Frames are due as
/// often as the result has them (the lower quartile of its steps: what is left out makes steps only
/// longer) wherever the truth is known. A result that shares no time with the truth is left as it
/// is: it is of something else.
void AddAbsentFrames(const FramesDue& due, std::vector<recon::SkeletonFrame>* frames);

}  // namespace ossa::tools
