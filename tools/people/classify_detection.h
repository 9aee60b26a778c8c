#pragma once
#include "tools/people/classify_candidates.h"

namespace ossa::people {

/// Classifies one candidate by the forest; for a track, the score is the mean over its frames.
Detection Classify(const ClassificationInput& input, Candidate candidate);

/// Combines the score with the pose network's. New candidates: unless they are foreground or were
/// split off a tracked person, where too little may be visible. Tracks: only where the forest is
/// not confident, and only upwards, because the network is unreliable for people who leave the
/// view.
void ApplyPoseNetwork(const ClassificationInput& input, Detection& detection);

/// Whether the score is that of a new person.
bool Passes(const Detection& detection, const InitiationOptions& options);

}  // namespace ossa::people
