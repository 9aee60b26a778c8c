#pragma once
#include <functional>
#include <vector>

#include "tools/people/detection.h"
#include "tools/people/geometry.h"
#include "tools/people/options.h"

// One body whose middle an own arm, or something held before it, occludes shows as several regions.
namespace ossa::people {

/// Which pieces meet in the image, over an edge of depth: side by side, or with nothing but nearer
/// surface, or the shadow that it casts, on a short straight way between them. Symmetrical: for
/// each piece the others, ascending.
std::vector<std::vector<size_t>> FindPiecesThatMeet(const PointGrid& grid,
                                                    const std::vector<Region>& pieces,
                                                    const JoinOptions& options);

/// A region as a person, with the word of all who judge that; `Detection::evidence` has the score.
using ClassifyRegion = std::function<Detection(Region)>;

/// How much it looks like a person by forest and network, also where the surface fit decides.
double MeasureLikeness(const Detection& detection);

/// Whether the lower border of the image cuts a region off.
bool GoesOnBelow(const PointGrid& grid, const Region& region, const JoinOptions& options);

/// What each piece grows to by those that meet it, as long as one more makes it look more like a
/// person; by the largest first. A piece that became part of another's whole starts none. Of those
/// that gain by no other only what is too small for a person and goes on below the image is a
/// whole.
std::vector<Detection> GrowOverEdges(const PointGrid& grid, const std::vector<Region>& pieces,
                                     const ClassifyRegion& classify,
                                     const CandidateOptions& options);

}  // namespace ossa::people
