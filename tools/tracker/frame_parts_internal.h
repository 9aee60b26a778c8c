#pragma once
#include "forest/classification/classify.h"
#include "forest/forest.h"
#include "tools/tracker/tracker.h"

namespace ossa::tracker {

/// Probabilities of a frame in which nobody is found yet: 0 everywhere.
PartProbabilities NobodyIn(const depth::DepthFrame& frame, const forest::ForestModel& model);

/// Enters a person's pixels.
void AddProbabilities(const forest::Classification& seen, PartProbabilities& probabilities);

/// Takes the pixels of somebody who turned out to be nobody out of parts and probabilities, where
/// the frame has them. Before they are taken out of `users`, which tells whose they are.
void ClearParts(int id, BodyFrame& frame);

/// Pixels that had no reading before holes were filled are nobody's.
void ClearHoles(const depth::DepthView& depth_mm, BodyFrame& frame);

}  // namespace ossa::tracker
