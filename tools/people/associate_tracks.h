#pragma once
#include <vector>

#include "tools/people/detection.h"

// Association of detected people with tracks.
namespace ossa::people {

/// All tracks, confirmed or lost.
struct TrackList {
  std::vector<Track> tracks;
  int next_id = 1;
};

/// Candidates that are not accepted as people yet but may be lost tracks. They compete in the
/// association, so that an accepted person does not take their track.
std::vector<Region> FindRivals(const std::vector<Candidate>& candidates);

/// Assigns the detected people of a frame their ids (same order), 1 to 255, and updates the tracks.
/// A new person never gets the id of a lost track. `rivals`: FindRivals of the frame.
std::vector<int> AssociateTracks(const Scene& scene, const std::vector<Region>& rivals,
                                 const std::vector<Detection>& people, double time_s,
                                 TrackList& list, const AssociationOptions& options = {});

/// Reuses the id of a new person whose acceptance was revoked before it was reported, unless later
/// ids were given.
void ReleaseId(int id, TrackList& list);

/// Confirmed and lost tracks after a frame. `ids`: of the people in it.
std::vector<TrackSummary> SummarizeTracks(const std::vector<Track>& tracks,
                                          const std::vector<int>& ids);

}  // namespace ossa::people
