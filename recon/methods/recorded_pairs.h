#pragma once
#include <cstddef>
#include <vector>

#include "recon/gp/pairs.h"
#include "recon/skeleton_sequence.h"

namespace ossa::recon {

/// Adds the pairs of two recordings of the same performance: frames with the same number (or, where
/// none is shared, the nearest time within 20 ms), bodies with the same id (or the first of each).
/// `group` says whose they are. Returns how many were added.
size_t AddPairs(const SkeletonSequence& observed, const SkeletonSequence& truth,
                std::vector<PosturePair>& pairs, int group = 0);

}  // namespace ossa::recon
