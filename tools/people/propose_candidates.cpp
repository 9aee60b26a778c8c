#include "tools/people/propose_candidates.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "tools/people/merge_regions.h"
#include "tools/people/occlusion_merge.h"
#include "tools/people/overhead.h"
#include "tools/people/split_regions.h"
#include "tools/people/track_prediction.h"

namespace ossa::people {
namespace {

using Eigen::Vector3f;

// Per-cell masks.
struct CellMasks {
  std::vector<int> owner;           // the track that it is predicted to belong to, -1 for none
  std::vector<uint8_t> background;  // unchanged background of no person: no track grows into it
  std::vector<uint8_t> ignored;     // floor, furniture, walls, unchanged background
};

// Somebody beside a cupboard may get into the plane of its front, and a plane may grow over
// somebody flat and close to a wall. They do not become a part of it.
void KeepTracksInPlane(const Scene& scene, const std::vector<Track>& tracks, double time_s,
                       const PredictionOptions& options, CellMasks& masks) {
  const depth::RoomShape& shape = scene.surfaces;
  const auto may_keep = [&](size_t cell) {
    if (masks.owner[cell] < 0 || !shape.room[cell] || shape.floor[cell]) return false;
    const Track& track = tracks[static_cast<size_t>(masks.owner[cell])];
    return shape.in_plane[cell] || time_s < track.certain_until_s ||
           track.score.value_or(0.0) >= options.plane_score;
  };
  std::vector<double> cells(tracks.size(), 0.0), of_plane(tracks.size(), 0.0);
  for (size_t i = 0; i < masks.owner.size(); ++i) {
    if (masks.owner[i] < 0) continue;
    cells[static_cast<size_t>(masks.owner[i])] += 1.0;
    of_plane[static_cast<size_t>(masks.owner[i])] += may_keep(i) ? 1.0 : 0.0;
  }
  for (size_t i = 0; i < masks.owner.size(); ++i) {
    if (!may_keep(i)) continue;
    const auto track = static_cast<size_t>(masks.owner[i]);
    if (of_plane[track] > options.in_plane_share * cells[track]) masks.ignored[i] = 0;
  }
}

// A wall does not come nearer: what stands out from the known room beside somebody on the floor is
// theirs, even in the plane of a wall that they lie along.
void KeepLying(const Scene& scene, const std::vector<Track>& tracks, double time_s,
               const PredictionOptions& options, CellMasks& masks) {
  if (!scene.floor) return;
  for (const Track& track : tracks) {
    const Vector3f mean_m = PredictMean_m(track, time_s, options.max_prediction_s);
    const bool is_low = scene.floor->HeightOf(mean_m.cast<double>()) < options.rest.floor_below_m;
    if (!is_low || time_s >= track.certain_until_s) continue;
    for (size_t i = 0; i < masks.ignored.size(); ++i) {
      if (!scene.background.foreground[i] || scene.surfaces.floor[i]) continue;
      const Vector3f off_m = scene.grid.at(static_cast<int>(i)) - mean_m;
      if (scene.grid.OnFloor(off_m).norm() < options.lying_reach_m) masks.ignored[i] = 0;
    }
  }
}

CellMasks MakeCellMasks(const Scene& scene, const std::vector<Track>& tracks, double time_s,
                        const PredictionOptions& options) {
  CellMasks masks;
  masks.owner = PredictOwners(scene.grid, tracks, time_s, options);
  masks.ignored = scene.surfaces.room;
  for (size_t i = 0; i < masks.ignored.size(); ++i)
    masks.ignored[i] |= scene.background.steady[i] && masks.owner[i] < 0;
  KeepLying(scene, tracks, time_s, options, masks);
  KeepTracksInPlane(scene, tracks, time_s, options, masks);
  return masks;
}

// A person who entered the scene is not part of its background: their track may enter cells of the
// known background by a rim only, whatever it covered in earlier frames. Otherwise it would spread
// over objects that the person passes.
void KeepTracksOutOfBackground(const Scene& scene, const std::vector<Track>& tracks,
                               CellMasks& masks) {
  masks.background = scene.background.known;
  for (size_t i = 0; i < masks.background.size(); ++i) {
    masks.background[i] &= masks.owner[i] < 0;
    const int owner = masks.owner[i];
    if (!scene.background.certain[i] || owner < 0 || !tracks[static_cast<size_t>(owner)].entered)
      continue;
    masks.owner[i] = -1;
    masks.background[i] = 1;
  }
}

std::vector<Region> FindRegions(const Scene& scene, const std::vector<Track>& tracks, double time_s,
                                CellMasks& masks, const CandidateOptions& options) {
  const PointGrid& grid = scene.grid;
  if (options.overhead) {
    if (!scene.floor) return {};  // heights are unknown
    return FindRegionsFromAbove(grid, *scene.floor, masks.ignored, options.speck_m2,
                                *options.overhead);
  }
  auto regions = FindConnectedRegions(grid, masks.ignored, options.speck_m2);
  ReleaseReturning(grid, regions, tracks, time_s, options, masks.owner);
  regions =
      MergePieces(grid, std::move(regions), scene.surfaces, masks.owner, tracks, time_s, options);
  regions =
      MergeBelowOccluder(grid, std::move(regions), tracks.size(), masks.owner, options.occlusion);
  regions = MergeBesideOccluder(grid, std::move(regions), scene.background.foreground, masks.owner,
                                tracks.size(), options);
  return MergeByTracks(grid, std::move(regions), masks.owner, tracks, time_s, options);
}

std::vector<HeadBlob> ListHeads(const Scene& scene, const Region& region,
                                const CandidateOptions& options) {
  return options.overhead ? FindHeadsFromAbove(scene.grid, *scene.floor, region, *options.overhead)
                          : FindHeads(scene.grid, region, options.heads);
}

// From above: limits a segment to the reach of the person with the largest_overlap head in it.
Region RemoveWalls(const Scene& scene, Region piece, std::span<const HeadBlob> heads,
                   const OverheadOptions& options) {
  for (const HeadBlob& head : heads) {
    if (std::binary_search(piece.cells.begin(), piece.cells.end(), head.cell))
      return KeepWithinReach(scene.grid, piece, head, options);
  }
  return piece;
}

// Whether a region is what is left to see of somebody who lies on the floor or behind something,
// or most of a tracked person of whom little more was visible.
bool IsRestOfPerson(const Region& region, const CellMasks& masks, const std::vector<Track>& tracks,
                    double time_s, const CandidateOptions& options) {
  if (region.area_m2 < options.min_rest_area_m2) return false;
  const int owner = FindMainOwner(region, masks.owner, tracks.size());
  if (owner < 0) return false;
  const Track& track = tracks[static_cast<size_t>(owner)];
  if (time_s < track.certain_until_s) return true;
  const auto common = std::ranges::count_if(
      region.cells, [&](int cell) { return masks.owner[static_cast<size_t>(cell)] == owner; });
  return static_cast<double>(common) > kMajority * static_cast<double>(track.cells.size());
}

// Splits a connected region into segments that may be one person each.
void SplitIntoCandidates(const DepthFrame& frame, const Scene& scene, const CellMasks& masks,
                         const std::vector<Track>& tracks, const Region& region, int region_index,
                         const CandidateOptions& options, Candidates& result) {
  const auto is_large_enough = [&](const Region& r) {
    return IsPersonSized(r, options) ||
           IsForegroundPersonSized(r, scene.background.foreground, options) ||
           IsRestOfPerson(r, masks, tracks, frame.time_s, options);
  };
  if (!is_large_enough(region)) {
    result.excluded.push_back(DescribeRegion(region, Rule::kTooSmall));
    return;
  }
  const std::vector<HeadBlob> heads = ListHeads(scene, region, options);
  const auto seeds =
      FindSeeds(scene.grid, region, heads, masks.owner, tracks.size(), masks.background, options);
  for (Region& piece : CutAtSeeds(scene.grid, region, seeds, options)) {
    if (options.overhead) piece = RemoveWalls(scene, std::move(piece), heads, *options.overhead);
    if (!is_large_enough(piece)) {
      if (!piece.cells.empty()) result.excluded.push_back(DescribeRegion(piece, Rule::kTooSmall));
      continue;
    }
    const bool has_seed = std::any_of(seeds.begin(), seeds.end(), [&](const Seed& seed) {
      return std::ranges::any_of(seed.cells, [&](int cell) {
        return std::binary_search(piece.cells.begin(), piece.cells.end(), cell);
      });
    });
    result.candidates.push_back(
        MakeCandidate(frame, scene, std::move(piece), has_seed, region_index, options));
    result.candidates.back().owner =
        FindMainOwner(result.candidates.back().region, masks.owner, tracks.size());
  }
}

// Each track continues in the candidate with the largest overlap, if that is a sufficient share of
// either, so that an adjacent object does not become the person. Nor does furniture that the person
// touched when they left the view: it is part of the known background, and they are not. Somebody
// on the floor is hardly in front of it.
void ContinueTracks(const CellMasks& masks, const std::vector<Track>& tracks,
                    const std::vector<uint8_t>& known_background, double time_s,
                    const PredictionOptions& options, std::vector<Candidate>& candidates) {
  std::vector<size_t> largest_overlap(tracks.size(), 0);
  std::vector<int> heir_candidate(tracks.size(), -1);
  for (size_t c = 0; c < candidates.size(); ++c) {
    const Region& region = candidates[c].region;
    const auto overlap = CollectOverlaps(region, masks.owner, tracks.size());
    const bool is_of_room = MeasureShare(region, known_background) > kMajority;
    const bool stands_out = StandsOut(candidates[c], options.rest);
    for (size_t t = 0; t < tracks.size(); ++t) {
      const bool lies = time_s - tracks[t].lay_s < options.rest.lay_s;
      const bool rests = (lies || stands_out) && time_s < tracks[t].certain_until_s;
      if (is_of_room && tracks[t].entered && !rests) continue;
      const size_t common = overlap[t].size();
      const size_t least =
          std::min(region.cells.size(), tracks[t].cells.size()) / options.overlap_fraction;
      if (common <= std::max(largest_overlap[t], least)) continue;
      largest_overlap[t] = common;
      heir_candidate[t] = static_cast<int>(c);
    }
  }
  // Where two tracks continue in one candidate, the one with the larger overlap is kept.
  std::vector<size_t> filled(candidates.size(), 0);
  for (size_t t = 0; t < tracks.size(); ++t) {
    if (heir_candidate[t] < 0) continue;
    const auto c = static_cast<size_t>(heir_candidate[t]);
    if (largest_overlap[t] <= filled[c]) continue;
    filled[c] = largest_overlap[t];
    candidates[c].track = static_cast<int>(t);
  }
}

// Whether a lost track was a person who may return, rather than a chance detection: noise and
// furniture that was one for a moment would come back again and again.
bool MayHaveLeft(const Track& track, double time_s, const PredictionOptions& options) {
  return time_s < track.certain_until_s || track.score.value_or(0.0) >= options.return_score;
}

void MarkReturningCandidates(const std::vector<Track>& tracks, double time_s, double forget_s,
                             const PredictionOptions& options, std::vector<Candidate>& candidates) {
  for (size_t t = 0; t < tracks.size(); ++t) {
    if (!MayHaveLeft(tracks[t], time_s, options)) continue;
    const auto goes_on = [t](const Candidate& c) { return c.track == static_cast<int>(t); };
    if (std::any_of(candidates.begin(), candidates.end(), goes_on)) continue;
    for (Candidate& candidate : candidates) {
      if (candidate.track < 0 &&
          MayReturnAs(tracks[t], candidate.region, time_s, forget_s, options))
        candidate.may_return_as.push_back(static_cast<int>(t));
    }
  }
}

// Horizontal distance between the nearest sides of two regions.
float MeasureGapOnFloor_m(const PointGrid& grid, const Region& a, const Region& b) {
  const float aside_m = std::max({0.0F, a.low_m.x() - b.high_m.x(), b.low_m.x() - a.high_m.x()});
  return std::hypot(aside_m, grid.OnFloor(a.mean_m - b.mean_m).y());
}

// A candidate that appears close to a tracked person may be part of them: it does not count as
// foreground or as isolated, unless it may be a lost track that returns.
void MarkPossibleParts(const PointGrid& grid, const std::vector<Track>& tracks, double time_s,
                       const CandidateOptions& options, std::vector<Candidate>& candidates) {
  for (Candidate& candidate : candidates) {
    if (candidate.track >= 0) continue;
    for (const Candidate& other : candidates) {
      if (other.track < 0) continue;
      const Track& track = tracks[static_cast<size_t>(other.track)];
      if (MeasureOffset_m(grid, track, candidate.region, time_s, options.prediction) <
              options.same_person_m &&
          !MayBeReturning(grid, candidate, track, tracks, time_s, options))
        candidate.foreground_share = 0;
      if (MeasureGapOnFloor_m(grid, candidate.region, other.region) < options.beside_person_m)
        candidate.isolated = false;
    }
  }
}

// The ignored surfaces, in regions large enough for a person.
void TraceIgnoredSurfaces(const Scene& scene, const CellMasks& masks,
                          const CandidateOptions& options, std::vector<Decision>& excluded) {
  const auto trace = [&](Rule rule, const auto& is_of_it) {
    std::vector<uint8_t> others(masks.ignored.size(), 1);
    for (size_t i = 0; i < others.size(); ++i) others[i] = is_of_it(i) ? 0 : 1;
    for (const Region& region : FindConnectedRegions(scene.grid, others, options.min_area_m2))
      excluded.push_back(DescribeRegion(region, rule));
  };
  const RoomShape& shape = scene.surfaces;
  trace(Rule::kFurniture, [&](size_t i) { return shape.room[i] && !shape.floor[i]; });
  trace(Rule::kBackground, [&](size_t i) { return masks.ignored[i] && !shape.room[i]; });
}

}  // namespace

Candidates ProposeCandidates(const DepthFrame& frame, const Scene& scene,
                             const std::vector<Track>& tracks, const ReidentifyOptions& reidentify,
                             const CandidateOptions& options, bool trace_surfaces) {
  CellMasks masks = MakeCellMasks(scene, tracks, frame.time_s, options.prediction);
  const auto regions = FindRegions(scene, tracks, frame.time_s, masks, options);
  KeepTracksOutOfBackground(scene, tracks, masks);
  Candidates result;
  for (size_t r = 0; r < regions.size(); ++r) {
    SplitIntoCandidates(frame, scene, masks, tracks, regions[r], static_cast<int>(r), options,
                        result);
  }
  std::vector<Candidate>& candidates = result.candidates;
  ContinueTracks(masks, tracks, scene.background.known, frame.time_s, options.prediction,
                 candidates);
  MarkReturningCandidates(tracks, frame.time_s, reidentify.forget_s, options.prediction,
                          candidates);
  MarkPossibleParts(scene.grid, tracks, frame.time_s, options, candidates);
  std::stable_sort(
      candidates.begin(), candidates.end(),
      [](const Candidate& a, const Candidate& b) { return a.region.area_m2 > b.region.area_m2; });
  if (trace_surfaces) TraceIgnoredSurfaces(scene, masks, options, result.excluded);
  return result;
}

}  // namespace ossa::people
