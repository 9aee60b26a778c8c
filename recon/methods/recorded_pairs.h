#pragma once
#include <cstddef>
#include <vector>

#include "recon/models/pairs.h"
#include "recon/skeleton_sequence.h"

namespace ossa::recon {

/// Adds the pairs of two recordings of the same performance: frames of the same number, where their
/// times agree; else the truth at the observed frame's time, between two frames at most 0.1 s apart
/// or in one within 20 ms. Bodies with the same id (or the first of each), one after the other.
/// `group` says whose they are. Returns how many were added.
size_t AddPairs(const SkeletonSequence& observed, const SkeletonSequence& truth,
                std::vector<PosturePair>& pairs, int group = 0);

}  // namespace ossa::recon
