#pragma once
#include <vector>

#include "tools/people/detection.h"

// Updating a track with its observation in a frame.
namespace ossa::people {

std::vector<float> CollectDepths(const PointGrid& grid, const Region& region);

/// `person_of`: the person that each cell belongs to in this frame (-1 for none); `self` is this
/// person.
void UpdateTrack(const PointGrid& grid, const Detection& person, const std::vector<int>& person_of,
                 int self, double time_s, const AssociationOptions& options, Track& track);

/// Resets score, age and facing: the track may be another person by now.
void ResetEvidence(Track& track);

}  // namespace ossa::people
