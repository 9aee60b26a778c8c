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

// What is known of each cell.
struct CellFacts {
  std::vector<int> owner;           // the track it belongs to by prediction, -1 nobody's
  std::vector<uint8_t> background;  // it was nobody's, and is as it was: no track grows into it
  std::vector<uint8_t> ignored;     // floor, furniture, walls, steady background
};

CellFacts GatherCellFacts(const Scene& scene, const std::vector<Track>& tracks, double time_s,
                          const PredictionOptions& options) {
  CellFacts facts;
  facts.owner = PredictOwners(scene.grid, tracks, time_s, options);
  facts.ignored = scene.surfaces.room;
  for (size_t i = 0; i < facts.ignored.size(); ++i)
    facts.ignored[i] |= scene.background.steady[i] && facts.owner[i] < 0;
  return facts;
}

// Who entered the room is not made of it: what was seen there before, nobody's, they enter by a rim
// only, however far they did in the frames before, or they would creep into what they pass.
void KeepTracksOutOfBackground(const Scene& scene, const std::vector<Track>& tracks,
                               CellFacts& facts) {
  facts.background = scene.background.known;
  for (size_t i = 0; i < facts.background.size(); ++i) {
    facts.background[i] &= facts.owner[i] < 0;
    const int owner = facts.owner[i];
    if (!scene.background.certain[i] || owner < 0 || !tracks[static_cast<size_t>(owner)].entered)
      continue;
    facts.owner[i] = -1;
    facts.background[i] = 1;
  }
}

std::vector<Region> FindRegions(const Scene& scene, const std::vector<Track>& tracks, double time_s,
                                CellFacts& facts, const CandidateOptions& options) {
  const PointGrid& grid = scene.grid;
  if (options.overhead) {
    if (!scene.floor) return {};  // without it nothing is known of heights
    return FindRegionsFromAbove(grid, *scene.floor, facts.ignored, options.speck_m2,
                                *options.overhead);
  }
  auto regions = FindConnectedRegions(grid, facts.ignored, options.speck_m2);
  regions =
      MergePieces(grid, std::move(regions), scene.surfaces, facts.owner, tracks.size(), options);
  regions =
      MergeBelowOccluder(grid, std::move(regions), tracks.size(), facts.owner, options.occlusion);
  regions = MergeBesideOccluder(grid, std::move(regions), scene.background.foreground, facts.owner,
                                tracks.size(), options);
  return MergeByTracks(grid, std::move(regions), facts.owner, tracks, time_s, options);
}

std::vector<HeadBlob> ListHeads(const Scene& scene, const Region& region,
                                const CandidateOptions& options) {
  return options.overhead ? FindHeadsFromAbove(scene.grid, *scene.floor, region, *options.overhead)
                          : FindHeads(scene.grid, region, options.heads);
}

// From above: each piece as far as the person under its highest-scored head may reach.
Region WithoutWalls(const Scene& scene, Region piece, std::span<const HeadBlob> heads,
                    const OverheadOptions& options) {
  for (const HeadBlob& head : heads) {
    if (std::binary_search(piece.cells.begin(), piece.cells.end(), head.cell))
      return KeepWithinReach(scene.grid, piece, head, options);
  }
  return piece;
}

// A connected region as pieces that may be one person each.
void CutIntoCandidates(const DepthFrame& frame, const Scene& scene, const CellFacts& facts,
                       size_t tracks, const Region& region, int region_index,
                       const CandidateOptions& options, Candidates& result) {
  const auto is_large_enough = [&](const Region& r) {
    return IsPersonSized(r, options) ||
           IsForegroundPersonSized(r, scene.background.foreground, options);
  };
  if (!is_large_enough(region)) {
    result.excluded.push_back(DescribeRegion(region, Rule::kTooSmall));
    return;
  }
  const std::vector<HeadBlob> heads = ListHeads(scene, region, options);
  const auto seeds =
      FindSeeds(scene.grid, region, heads, facts.owner, tracks, facts.background, options);
  for (Region& piece : CutAtSeeds(scene.grid, region, seeds, options)) {
    if (options.overhead) piece = WithoutWalls(scene, std::move(piece), heads, *options.overhead);
    if (!is_large_enough(piece)) {
      if (!piece.cells.empty()) result.excluded.push_back(DescribeRegion(piece, Rule::kTooSmall));
      continue;
    }
    result.candidates.push_back(
        MakeCandidate(frame, scene, std::move(piece), !seeds.empty(), region_index, options));
  }
}

// Each track goes on in the one candidate that holds most of its cells, if that is a good part of
// either: what merely touches a person is not that person. Nor is the furniture they touched while
// they went out of view: it was seen there before, they were not.
void ContinueTracks(const CellFacts& facts, const std::vector<Track>& tracks,
                    const std::vector<uint8_t>& known_background, const PredictionOptions& options,
                    std::vector<Candidate>& candidates) {
  std::vector<size_t> best(tracks.size(), 0);
  std::vector<int> heir(tracks.size(), -1);
  for (size_t c = 0; c < candidates.size(); ++c) {
    const Region& region = candidates[c].region;
    const auto overlap = CollectOverlaps(region, facts.owner, tracks.size());
    const bool is_of_room = MeasureShare(region, known_background) > kMostly;
    for (size_t t = 0; t < tracks.size(); ++t) {
      if (is_of_room && tracks[t].entered) continue;
      const size_t common = overlap[t].size();
      const size_t least =
          std::min(region.cells.size(), tracks[t].cells.size()) / options.overlap_fraction;
      if (common <= std::max(best[t], least)) continue;
      best[t] = common;
      heir[t] = static_cast<int>(c);
    }
  }
  // Two tracks in one candidate: the one that fills more of it goes on.
  std::vector<size_t> filled(candidates.size(), 0);
  for (size_t t = 0; t < tracks.size(); ++t) {
    if (heir[t] < 0) continue;
    const auto c = static_cast<size_t>(heir[t]);
    if (best[t] <= filled[c]) continue;
    filled[c] = best[t];
    candidates[c].track = static_cast<int>(t);
  }
}

void MarkWhereTheLostMayReturn(const std::vector<Track>& tracks, double time_s, double forget_s,
                               const PredictionOptions& options,
                               std::vector<Candidate>& candidates) {
  for (size_t t = 0; t < tracks.size(); ++t) {
    const auto goes_on = [t](const Candidate& c) { return c.track == static_cast<int>(t); };
    if (std::any_of(candidates.begin(), candidates.end(), goes_on)) continue;
    for (Candidate& candidate : candidates) {
      if (candidate.track < 0 &&
          MayReturnAs(tracks[t], candidate.region, time_s, forget_s, options))
        candidate.may_return = true;
    }
  }
}

// Over the floor, from the nearer sides of two regions.
float MeasureGapOnFloor_m(const PointGrid& grid, const Region& a, const Region& b) {
  const float aside_m = std::max({0.0F, a.low_m.x() - b.high_m.x(), b.low_m.x() - a.high_m.x()});
  return std::hypot(aside_m, grid.OnFloor(a.mean_m - b.mean_m).y());
}

// What comes into view close to somebody who is seen may be the rest of them: of it nothing is
// taken for granted.
void MarkPossibleRests(const PointGrid& grid, const std::vector<Track>& tracks, double time_s,
                       const CandidateOptions& options, std::vector<Candidate>& candidates) {
  for (Candidate& candidate : candidates) {
    if (candidate.track >= 0) continue;
    for (const Candidate& other : candidates) {
      if (other.track < 0) continue;
      const Vector3f off_m = PredictMean_m(tracks[static_cast<size_t>(other.track)], time_s,
                                           options.prediction.max_prediction_s) -
                             candidate.region.mean_m;
      if (grid.OnFloor(off_m).norm() < options.rest_m) candidate.foreground_share = 0;
      if (MeasureGapOnFloor_m(grid, candidate.region, other.region) < options.beside_m)
        candidate.isolated = false;
    }
  }
}

// Pieces of the surfaces that no candidate is of, where they are large enough for a person.
void TraceIgnoredSurfaces(const Scene& scene, const CellFacts& facts,
                          const CandidateOptions& options, std::vector<Decision>& excluded) {
  const auto trace = [&](Rule rule, const auto& is_of_it) {
    std::vector<uint8_t> others(facts.ignored.size(), 1);
    for (size_t i = 0; i < others.size(); ++i) others[i] = is_of_it(i) ? 0 : 1;
    for (const Region& region : FindConnectedRegions(scene.grid, others, options.min_area_m2))
      excluded.push_back(DescribeRegion(region, rule));
  };
  const RoomShape& shape = scene.surfaces;
  trace(Rule::kFurniture, [&](size_t i) { return shape.room[i] && !shape.floor[i]; });
  trace(Rule::kBackground, [&](size_t i) { return facts.ignored[i] && !shape.room[i]; });
}

}  // namespace

Candidates ProposeCandidates(const DepthFrame& frame, const Scene& scene,
                             const std::vector<Track>& tracks, const ReidentifyOptions& reidentify,
                             const CandidateOptions& options, bool trace_surfaces) {
  CellFacts facts = GatherCellFacts(scene, tracks, frame.time_s, options.prediction);
  const auto regions = FindRegions(scene, tracks, frame.time_s, facts, options);
  KeepTracksOutOfBackground(scene, tracks, facts);
  Candidates result;
  for (size_t r = 0; r < regions.size(); ++r) {
    CutIntoCandidates(frame, scene, facts, tracks.size(), regions[r], static_cast<int>(r), options,
                      result);
  }
  std::vector<Candidate>& candidates = result.candidates;
  ContinueTracks(facts, tracks, scene.background.known, options.prediction, candidates);
  MarkWhereTheLostMayReturn(tracks, frame.time_s, reidentify.forget_s, options.prediction,
                            candidates);
  MarkPossibleRests(scene.grid, tracks, frame.time_s, options, candidates);
  std::stable_sort(
      candidates.begin(), candidates.end(),
      [](const Candidate& a, const Candidate& b) { return a.region.area_m2 > b.region.area_m2; });
  if (trace_surfaces) TraceIgnoredSurfaces(scene, facts, options, result.excluded);
  return result;
}

}  // namespace ossa::people
