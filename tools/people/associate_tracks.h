#pragma once
#include <vector>

#include "tools/people/detection.h"

// Who is who from one frame to the next.
namespace ossa::people {

/// Everybody who is followed, confirmed or lost a moment ago.
struct TrackList {
  std::vector<Track> tracks;
  int next_id = 1;
};

/// Candidates that nobody takes for a person yet, but which may be lost tracks: they leave the
/// others to those who are people.
std::vector<Region> FindRivals(const std::vector<Candidate>& candidates);

/// Gives the detected people of a frame their identities (same order), 1 to 255, and updates their
/// tracks. Nobody gets the identity of somebody who is remembered. `rivals`: FindRivals of the
/// frame.
std::vector<int> AssociateTracks(const Scene& scene, const std::vector<Region>& rivals,
                                 const std::vector<Detection>& people, double time_s,
                                 TrackList& list, const AssociationOptions& options = {});

/// Somebody new turned out to be nobody before anybody was told: the next one new gets the id,
/// unless others came after them.
void GiveBackId(int id, TrackList& list);

/// Confirmed and lost tracks, as of a frame. `ids`: of the people in it.
std::vector<TrackSummary> SummarizeTracks(const std::vector<Track>& tracks,
                                          const std::vector<int>& ids);

}  // namespace ossa::people
