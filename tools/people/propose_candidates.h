#pragma once
#include <vector>

#include "tools/people/candidate.h"
#include "tools/people/decision.h"
#include "tools/people/track.h"

namespace ossa::people {

/// The candidates of a frame, largest first, and what geometry excluded.
struct Candidates {
  std::vector<Candidate> candidates;
  std::vector<Decision> excluded;  // kTooSmall; of large surfaces kFurniture, kBackground on demand
};

/// What of a frame may be people, by geometry alone; the tracks of the frames before make it
/// better. Nothing is claimed to be a person. `trace_surfaces`: `excluded` also holds the surfaces
/// that are not looked at, in pieces large enough for a person.
Candidates ProposeCandidates(const DepthFrame& frame, const Scene& scene,
                             const std::vector<Track>& tracks, const ReidentifyOptions& reidentify,
                             const CandidateOptions& options, bool trace_surfaces = false);

}  // namespace ossa::people
