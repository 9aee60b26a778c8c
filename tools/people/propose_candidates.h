#pragma once
#include <vector>

#include "tools/people/candidate.h"
#include "tools/people/decision.h"
#include "tools/people/track.h"

namespace ossa::people {

/// The candidates of a frame, largest first, and the regions that geometry excluded.
struct Candidates {
  std::vector<Candidate> candidates;
  std::vector<Decision> excluded;  // kTooSmall; with `trace_surfaces` kFurniture and kBackground
};

/// Proposes segments that may be people, by geometry and the tracks of earlier frames, with high
/// recall and low precision. `trace_surfaces`: `excluded` also holds ignored surfaces, in regions
/// large enough for a person.
Candidates ProposeCandidates(const DepthFrame& frame, const Scene& scene,
                             const std::vector<Track>& tracks, const ReidentifyOptions& reidentify,
                             const CandidateOptions& options, bool trace_surfaces = false);

}  // namespace ossa::people
