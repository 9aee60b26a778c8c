#pragma once
#include <vector>

#include "tools/people/geometry.h"
#include "tools/people/options.h"
#include "tools/people/track.h"

// Predicted places of the tracks of earlier frames.
namespace ossa::people {

/// The track that each cell is predicted to belong to, as an index: near the predicted place of the
/// track's cells, at a similar depth. -1 for none.
std::vector<int> PredictOwners(const PointGrid& grid, const std::vector<Track>& tracks,
                               double time_s, const PredictionOptions& options = {});

/// The cells of the region that each track owns.
std::vector<std::vector<int>> CollectOverlaps(const Region& region, const std::vector<int>& owner,
                                              size_t tracks);

/// The track that owns at least half of the region's cells; -1 for none, and for a region without
/// cells.
int FindMainOwner(const Region& region, const std::vector<int>& owner, size_t tracks);

/// Horizontal distance from a track's predicted centroid to a region's.
float MeasureOffset_m(const PointGrid& grid, const Track& track, const Region& region,
                      double time_s, const PredictionOptions& options = {});

/// Whether a track is expected near a region now, in a gate that grows with the time since it was
/// last seen.
bool IsExpectedAt(const Track& track, const Region& region, double time_s,
                  const PredictionOptions& options = {});

/// Whether a region where a lost track is expected may be that one rather than a part of `other`:
/// far from `other`, or at another depth, which is the lost track's.
bool IsRatherOf(const PointGrid& grid, const Region& region, const Track& lost, const Track& other,
                double time_s, const CandidateOptions& options);

/// Whether a lost track is expected near a region now. It is deleted after `forget_s`.
bool MayReturnAs(const Track& track, const Region& region, double time_s, double forget_s,
                 const PredictionOptions& options = {});

/// Whether an object moved or changed its visible surface since its first observation. Furniture
/// does neither; people shift, breathe and turn.
bool HasMoved(const Eigen::Vector3f& first_mean_m, float first_m2, const Region& now,
              const MotionOptions& options = {});

/// Whether a lost track is to be deleted.
bool IsForgotten(const Track& track, double time_s, const ReidentifyOptions& options);

}  // namespace ossa::people
