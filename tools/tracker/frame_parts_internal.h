#pragma once
#include "forest/classification/classify.h"
#include "forest/forest.h"
#include "tools/tracker/tracker.h"

namespace ossa::tracker {

/// Probabilities of a frame without people: 0 everywhere.
PartProbabilities ZeroProbabilities(const depth::DepthFrame& frame,
                                    const forest::ForestModel& model);

/// Copies the probabilities of a person's pixels.
void AddProbabilities(const forest::Classification& seen, PartProbabilities& probabilities);

/// Clears parts and probabilities of a revoked person, where the frame has them. Must be called
/// before their pixels are cleared in `users`.
void ClearParts(int id, BodyFrame& frame);

/// Clears pixels that had no reading before holes were filled.
void ClearHoles(const depth::DepthView& depth_mm, BodyFrame& frame);

}  // namespace ossa::tracker
