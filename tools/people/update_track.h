#pragma once
#include <vector>

#include "tools/people/detection.h"

// What a track takes over from a frame in which it was seen.
namespace ossa::people {

std::vector<float> CollectDepths(const PointGrid& grid, const Region& region);

/// `person_of` says whose each cell is in this frame (-1 nobody's), where the person is `self`.
void UpdateTrack(const PointGrid& grid, const Detection& person, const std::vector<int>& person_of,
                 int self, double time_s, const AssociationOptions& options, Track& track);

/// Forgets what the forest saw of somebody: they may be anybody.
void ForgetEvidence(Track& track);

}  // namespace ossa::people
