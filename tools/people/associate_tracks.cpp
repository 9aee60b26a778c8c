#include "tools/people/associate_tracks.h"

#include <algorithm>
#include <cmath>

#include "recon/filters/frame_steps.h"
#include "tools/people/reidentify.h"
#include "tools/people/track_prediction.h"
#include "tools/people/update_track.h"

namespace ossa::people {
namespace {

// Cells that the track and the person have in common, at about the same depth.
size_t CountCommonCells(const PointGrid& grid, const Track& track, const Region& person,
                        float same_depth_m) {
  size_t common = 0, i = 0;
  for (const int cell : person.cells) {
    while (i < track.cells.size() && track.cells[i] < cell) ++i;
    if (i < track.cells.size() && track.cells[i] == cell &&
        std::abs(track.z_m[i] - grid.z(cell)) < same_depth_m) {
      ++common;
    }
  }
  return common;
}

// Common cells, as a share of the smaller segment.
double MeasureOverlap(const PointGrid& grid, const Track& track, const Region& person,
                      float same_depth_m) {
  if (track.cells.empty()) return 0;
  return static_cast<double>(CountCommonCells(grid, track, person, same_depth_m)) /
         static_cast<double>(std::min(track.cells.size(), person.cells.size()));
}

// The person that each cell belongs to, as an index into `people`; -1 for none.
std::vector<int> MapCellsToPeople(const PointGrid& grid, const std::vector<Detection>& people) {
  std::vector<int> person_of(static_cast<size_t>(grid.cells()), -1);
  for (size_t p = 0; p < people.size(); ++p) {
    for (const int cell : people[p].candidate.region.cells)
      person_of[static_cast<size_t>(cell)] = static_cast<int>(p);
  }
  return person_of;
}

// The track that each person continues by overlap; -1 for none. Where a person is split in two, the
// track goes to the segment with far more common cells, whichever was associated first, so that ids
// do not alternate.
std::vector<int> FindContinuedTracks(const PointGrid& grid, const std::vector<Detection>& people,
                                     const std::vector<Track>& tracks,
                                     const AssociationOptions& options) {
  std::vector<int> track_of;
  for (const Detection& person : people) track_of.push_back(person.candidate.track);
  for (size_t p = 0; p < people.size(); ++p) {
    const int t = people[p].candidate.track;
    if (t < 0) continue;
    const auto count = [&](const Detection& person) {
      return CountCommonCells(grid, tracks[static_cast<size_t>(t)], person.candidate.region,
                              options.same_depth_m);
    };
    size_t most = options.takeover_factor * count(people[p]), best = p;
    for (size_t other = 0; other < people.size(); ++other) {
      if (track_of[other] >= 0) continue;
      const size_t common = count(people[other]);
      if (common > most) most = common, best = other;
    }
    if (best != p) std::swap(track_of[p], track_of[best]);
  }
  return track_of;
}

// Rivals whose cells do not belong to people by now.
std::vector<const Region*> SelectFreeRivals(const std::vector<Region>& rivals,
                                            const std::vector<int>& person_of, double taken_share) {
  std::vector<const Region*> free;
  for (const Region& rival : rivals) {
    const auto taken = std::count_if(rival.cells.begin(), rival.cells.end(), [&](int cell) {
      return person_of[static_cast<size_t>(cell)] >= 0;
    });
    if (static_cast<double>(taken) < taken_share * static_cast<double>(rival.cells.size()))
      free.push_back(&rival);
  }
  return free;
}

// Tracks without a person in this frame, as indices.
std::vector<size_t> FindLostTracks(const std::vector<Detection>& people,
                                   const std::vector<int>& track_of, size_t tracks) {
  std::vector<uint8_t> taken(tracks, 0);
  for (size_t p = 0; p < people.size(); ++p) {
    for (const int track : people[p].candidate.absorbed) taken[static_cast<size_t>(track)] = 1;
    if (track_of[p] >= 0) taken[static_cast<size_t>(track_of[p])] = 1;
  }
  std::vector<size_t> lost;
  for (size_t t = 0; t < tracks; ++t) {
    if (!taken[t]) lost.push_back(t);
  }
  return lost;
}

// The track of each person: by overlap with the frame before, and for all others by the best
// assignment to the lost tracks. -1 for a new person.
std::vector<int> AssignTracks(const Scene& scene, const std::vector<Region>& rivals,
                              const std::vector<Detection>& people,
                              const std::vector<int>& person_of, double time_s,
                              const std::vector<Track>& tracks, const AssociationOptions& options) {
  const PointGrid& grid = scene.grid;
  std::vector<int> track_of = FindContinuedTracks(grid, people, tracks, options);
  const std::vector<size_t> lost = FindLostTracks(people, track_of, tracks.size());
  std::vector<size_t> unknown;
  for (size_t p = 0; p < people.size(); ++p) {
    if (track_of[p] < 0) unknown.push_back(p);
  }
  if (unknown.empty() || lost.empty()) return track_of;
  std::vector<std::vector<double>> weight;
  const auto add = [&](const Region& region, const FrameMeasures& measures, int self, double less) {
    const Entrance entrance = FindEntrance(grid, region.cells, CollectDepths(grid, region),
                                           person_of, self, options.reidentify);
    weight.emplace_back();
    for (const size_t t : lost) {
      const Track& track = tracks[t];
      const double overlap = time_s - track.last_seen_s < options.overlap_s
                                 ? MeasureOverlap(grid, track, region, options.same_depth_m)
                                 : 0.0;
      weight.back().push_back(
          ComputeLostTrackLogOdds(grid, track, region.mean_m, measures, entrance, time_s,
                                  options.reidentify) +
          (overlap > options.min_overlap ? options.overlap_log_odds * overlap : 0.0) - less);
    }
  };
  for (const size_t p : unknown)
    add(people[p].candidate.region, people[p].measures, static_cast<int>(p), 0.0);
  for (const Region* rival : SelectFreeRivals(rivals, person_of, options.max_rival_taken_share))
    add(*rival, {}, -1, options.rival_log_odds);
  const std::vector<int> assigned = FindBestAssignment(weight, lost.size());
  for (size_t i = 0; i < unknown.size(); ++i) {
    if (assigned[i] >= 0)
      track_of[unknown[i]] = static_cast<int>(lost[static_cast<size_t>(assigned[i])]);
  }
  return track_of;
}

bool IsAmong(const std::vector<int>& ids, int id) {
  return std::find(ids.begin(), ids.end(), id) != ids.end();
}

// Whether a track is on the floor and moved not too long ago. With a carried sensor nothing is
// known of the room.
bool IsLying(const Scene& scene, const Candidate& candidate, double time_s,
             const AssociationOptions& options, const Track& track) {
  if (!scene.floor || scene.background.certain_share <= kMajority) return false;
  const Region& region = candidate.region;
  const Eigen::Vector3f top_m(region.mean_m.x(), region.high_m.y(), region.mean_m.z());
  return time_s - track.moved_s < options.lying_s &&
         scene.floor->HeightOf(track.mean_m.cast<double>()) < options.rest.floor_below_m &&
         scene.floor->HeightOf(top_m.cast<double>()) < options.lying_top_m;
}

// Who was a person for sure stays one while they move, and on the floor for longer.
void StayCertain(const Scene& scene, const Candidate& candidate, double time_s,
                 const AssociationOptions& options, Track& track) {
  if (!StandsOut(candidate, options.rest)) return;
  track.certain_until_s = std::max(track.certain_until_s, track.moved_s + options.certain_s);
  if (!IsLying(scene, candidate, time_s, options, track)) return;
  track.lay_s = time_s;
  track.certain_until_s = time_s + options.certain_s;
}

// Updates tracks that went out of view. `ids`: of the people in this frame.
void MarkLostTracks(const Scene& scene, const std::vector<int>& person_of,
                    const std::vector<int>& ids, double time_s, const AssociationOptions& options,
                    std::vector<Track>& tracks) {
  for (Track& track : tracks) {
    if (IsAmong(ids, track.id) || track.cells.empty()) continue;
    track.lost_behind =
        track.lost_behind || FindEntrance(scene.grid, track.cells, track.z_m, person_of, -1,
                                          options.reidentify) == Entrance::kBehind;
    if (track.last_seen_s < time_s - options.keep_cells_s) track.cells.clear(), track.z_m.clear();
  }
}

constexpr int kLargestId = 255;  // so that ids fit the user image's byte

int NextId(int id) { return id % kLargestId + 1; }

bool HasId(const std::vector<Track>& tracks, int id) {
  return std::any_of(tracks.begin(), tracks.end(),
                     [&](const Track& track) { return track.id == id; });
}

// The next free id. LimitTrackCount guarantees that there is one.
int AllocateId(TrackList& list) {
  int id = list.next_id;
  while (HasId(list.tracks, id)) id = NextId(id);
  list.next_id = NextId(id);
  return id;
}

// Where timestamps stand still no track expires; this keeps the ids from running out. The oldest
// lost tracks are deleted, so that half of the ids are free for the next frame.
void LimitTrackCount(const std::vector<int>& ids, std::vector<Track>& tracks) {
  constexpr size_t kMost = kLargestId / 2;
  size_t too_many = std::max(tracks.size(), kMost) - kMost;
  std::erase_if(tracks, [&](const Track& track) {
    const bool goes = too_many > 0 && !IsAmong(ids, track.id);
    too_many -= goes ? 1 : 0;
    return goes;
  });
}

// Deletes tracks that proved to be parts of another person, so that they claim no cells.
void DeleteAbsorbed(const std::vector<Detection>& people, const std::vector<int>& ids,
                    std::vector<Track>& tracks) {
  std::vector<int> absorbed;
  for (const Detection& person : people) {
    for (const int track : person.candidate.absorbed)
      absorbed.push_back(tracks[static_cast<size_t>(track)].id);
  }
  std::erase_if(tracks, [&](const Track& track) {
    return IsAmong(absorbed, track.id) && !IsAmong(ids, track.id);
  });
}

// Where timestamps go back another recording begins, in which the tracks continue. Returns the ids
// of the tracks that were last seen later than now by more than timestamp jitter.
std::vector<int> RewindTracks(double time_s, std::vector<Track>& tracks) {
  std::vector<int> ids;
  for (Track& track : tracks) {
    if (time_s >= track.last_seen_s) continue;
    // Otherwise the track would count as recently moved until that time comes again.
    const double back_s = track.last_seen_s - time_s;
    track.moved_s -= back_s;
    track.facing_s -= back_s;
    track.certain_until_s -= back_s;
    track.lay_s -= back_s;
    track.last_seen_s = time_s;
    if (back_s >= recon::FrameSteps::kJitter_s) ids.push_back(track.id);
  }
  return ids;
}

}  // namespace

std::vector<Region> FindRivals(const std::vector<Candidate>& candidates) {
  std::vector<Region> rivals;
  for (const Candidate& candidate : candidates) {
    if (candidate.track < 0 && IsForeground(candidate) && !candidate.may_return_as.empty())
      rivals.push_back(candidate.region);
  }
  return rivals;
}

std::vector<int> AssociateTracks(const Scene& scene, const std::vector<Region>& rivals,
                                 const std::vector<Detection>& people, double time_s,
                                 TrackList& list, const AssociationOptions& options) {
  std::vector<Track>& tracks = list.tracks;
  const std::vector<int> of_later = RewindTracks(time_s, tracks);
  const std::vector<int> person_of = MapCellsToPeople(scene.grid, people);
  std::vector<int> track_of =
      AssignTracks(scene, rivals, people, person_of, time_s, tracks, options);
  std::vector<int> ids;
  for (size_t p = 0; p < people.size(); ++p) {
    if (track_of[p] < 0) {
      track_of[p] = static_cast<int>(tracks.size());
      Track track;
      track.id = AllocateId(list);
      tracks.push_back(std::move(track));
    }
    Track& track = tracks[static_cast<size_t>(track_of[p])];
    const bool was_certain = time_s < track.certain_until_s;
    UpdateTrack(scene.grid, people[p], person_of, static_cast<int>(p), time_s, options, track);
    if (was_certain) StayCertain(scene, people[p].candidate, time_s, options, track);
    ids.push_back(track.id);
  }
  DeleteAbsorbed(people, ids, tracks);
  std::erase_if(tracks,
                [&](const Track& track) { return IsForgotten(track, time_s, options.reidentify); });
  LimitTrackCount(ids, tracks);
  MarkLostTracks(scene, person_of, ids, time_s, options, tracks);
  for (Track& track : tracks) {
    if (IsAmong(of_later, track.id) && !IsAmong(ids, track.id)) ResetEvidence(track);
  }
  return ids;
}

void ReleaseId(int id, TrackList& list) {
  if (list.next_id == NextId(id)) list.next_id = id;
}

std::vector<TrackSummary> SummarizeTracks(const std::vector<Track>& tracks,
                                          const std::vector<int>& ids) {
  std::vector<TrackSummary> summaries;
  for (const Track& track : tracks) {
    const TrackStatus status =
        IsAmong(ids, track.id) ? TrackStatus::kConfirmed : TrackStatus::kLost;
    summaries.push_back({track.id, status, track.last_seen_s, track.age});
  }
  return summaries;
}

std::vector<uint8_t> MarkPeople(const Scene& scene, const std::vector<Detection>& people,
                                const std::vector<Track>& tracks, double time_s) {
  const PointGrid& grid = scene.grid;
  std::vector<uint8_t> marked(static_cast<size_t>(grid.cells()), 0);
  for (const Detection& person : people) {
    for (const int cell : person.candidate.region.cells) marked[static_cast<size_t>(cell)] = 1;
  }
  if (scene.background.certain_share <= kMajority) return marked;
  for (const Track& track : tracks) {
    if (time_s >= track.certain_until_s || track.last_seen_s == time_s) continue;
    for (size_t i = 0; i < track.cells.size(); ++i) {
      const float off_m = std::abs(grid.z(track.cells[i]) - track.z_m[i]);
      if (off_m < depth::DepthTolerance(track.z_m[i]))
        marked[static_cast<size_t>(track.cells[i])] = 1;
    }
  }
  return marked;
}

}  // namespace ossa::people
