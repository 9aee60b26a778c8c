#pragma once
#include <vector>

#include "tools/people/geometry.h"
#include "tools/people/options.h"
#include "tools/people/track.h"

// Where the tracks of the frames before are expected now.
namespace ossa::people {

/// Which track each cell belongs to, as an index: near where the track's cells went, at a similar
/// depth. -1 for none.
std::vector<int> PredictOwners(const PointGrid& grid, const std::vector<Track>& tracks,
                               double time_s, const PredictionOptions& options = {});

/// Cells of the region that each track owns.
std::vector<std::vector<int>> CollectOverlaps(const Region& region, const std::vector<int>& owner,
                                              size_t tracks);

/// The track that owns at least half of the region's cells; -1 for none, and for a region without
/// cells.
int FindMainOwner(const Region& region, const std::vector<int>& owner, size_t tracks);

/// Whether a track that is out of view is expected about here and now. It is forgotten after
/// `forget_s`.
bool MayReturnAs(const Track& track, const Region& region, double time_s, double forget_s,
                 const PredictionOptions& options = {});

/// Whether something shifted or shows another surface than at first. Furniture stays where it is
/// and shows the same surface; people shift, breathe and turn.
bool HasMoved(const Eigen::Vector3f& first_mean_m, float first_m2, const Region& now,
              const MotionOptions& options = {});

/// Whether a track has been out of view for too long.
bool IsForgotten(const Track& track, double time_s, const ReidentifyOptions& options);

}  // namespace ossa::people
