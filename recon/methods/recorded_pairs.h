#pragma once
#include <cstddef>
#include <vector>

#include "recon/models/pairs.h"
#include "recon/skeleton_sequence.h"

namespace ossa::recon {

/// Adds the pairs of two recordings of the same motion: by frame number if the times agree; else
/// the truth at the observed frame's time, interpolated over at most 0.1 s, or from one frame
/// within 20 ms. Bodies are paired by id (or the first of each), one after another. `group`
/// identifies the person. Returns the number of pairs added.
size_t AddPairs(const SkeletonSequence& observed, const SkeletonSequence& truth,
                std::vector<PosturePair>& pairs, int group = 0);

}  // namespace ossa::recon
