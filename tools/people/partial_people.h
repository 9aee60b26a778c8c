#pragma once
#include <vector>

#include "tools/people/classify_candidates.h"

namespace ossa::people {

// People whose connected region is not theirs alone, or not whole. Detections that were replaced go
// to `decided`.

/// A rejected candidate may be a person with the furniture they touch. Tried only in frames without
/// people: beside a person it would as often be an object they hold.
void RetryAroundHeads(const ClassificationInput& input, std::vector<Detection>& detections,
                      std::vector<Decision>& decided);

/// The connected region of a tracked person includes that furniture again in each frame, unless the
/// known background separates it.
void CropTracksAroundHeads(const ClassificationInput& input, std::vector<Detection>& detections,
                           std::vector<Decision>& decided);

/// The same of what lately seemed a person alone and is part of a larger region in this frame.
void CropLikelyAroundHeads(const ClassificationInput& input, std::vector<Detection>& detections,
                           std::vector<Decision>& decided);

/// Joins rejected regions, most of them too small to be candidates, which may be one person whose
/// middle an arm or a held object occludes. That person replaces the detections it consists of.
void RetryWithJoinedPieces(const ClassificationInput& input, std::vector<Detection>& detections,
                           std::vector<Decision>& decided);

}  // namespace ossa::people
