#pragma once
#include <functional>
#include <vector>

#include "tools/people/detection.h"
#include "tools/people/geometry.h"
#include "tools/people/options.h"

// Merging the regions of one person whose middle an own arm or a held object occludes.
namespace ossa::people {

/// The pairs of pieces that are adjacent in the image across a depth edge: side by side, or with
/// only nearer surface, or its shadow, on a short horizontal or vertical line between them.
/// Symmetrical: for each piece the others, ascending.
std::vector<std::vector<size_t>> FindAdjacentPieces(const PointGrid& grid,
                                                    const std::vector<Region>& pieces,
                                                    const JoinOptions& options);

/// Classifies a region by all models; `Detection::evidence` has the score.
using ClassifyRegion = std::function<Detection(Region)>;

/// The score by forest and network, also where the surface fit decides.
double GetPersonScore(const Detection& detection);

/// Whether the lower image border cuts a region off.
bool IsCutByLowerBorder(const PointGrid& grid, const Region& region, const JoinOptions& options);

/// Grows each piece by adjacent ones, the largest first, while that raises the score. A piece that
/// was added to another starts none. A piece that grows by no other is returned only if it is too
/// small for a person and cut off by the lower image border.
std::vector<Detection> GrowAcrossDepthEdges(const PointGrid& grid,
                                            const std::vector<Region>& pieces,
                                            const ClassifyRegion& classify,
                                            const CandidateOptions& options);

}  // namespace ossa::people
