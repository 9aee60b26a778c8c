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

/// The cells of a frame that are not to be learned as the room: those of its people, and those of a
/// person for sure who was seen a moment ago where nothing has changed since. Somebody who lies on
/// the floor is missed in a frame now and then, and would be the room before they are found again.
/// One entry per cell of the grid, 1 = yes. With a carried sensor, only those of its people.
std::vector<uint8_t> MarkPeople(const Scene& scene, const std::vector<Detection>& people,
                                const std::vector<Track>& tracks, double time_s);

}  // namespace ossa::people
