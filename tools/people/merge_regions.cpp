#include "tools/people/merge_regions.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include "tools/people/occlusion_merge.h"
#include "tools/people/planar_occluder.h"
#include "tools/people/track_prediction.h"

namespace ossa::people {
namespace {

// The shortest distances, metres, between the cells of a small region and each large one, whose
// index `label` has. Only cells nearby in the image are compared, so that a region behind does not
// reach around.
std::vector<float> MeasureGaps_m(const PointGrid& grid, const Region& small,
                                 const std::vector<int>& label, size_t big,
                                 const MergeOptions& options) {
  constexpr int kStep = 2;          // by hand, cells: every other one is near enough
  constexpr float kFar_m2 = 1e18F;  // by hand: out of reach
  std::vector<float> nearest_m2(big, kFar_m2);
  for (const int cell : small.cells) {
    const int x = cell % grid.width, y = cell / grid.width;
    const int reach = std::clamp(static_cast<int>(grid.CellsOf(options.search_m, grid.z(cell))),
                                 options.min_search_cells, options.max_search_cells);
    const auto first = [reach](int from) {
      return std::max(from - reach, (from - reach) & (kStep - 1));
    };
    for (int v = first(y); v <= std::min(y + reach, grid.height - 1); v += kStep) {
      for (int u = first(x); u <= std::min(x + reach, grid.width - 1); u += kStep) {
        const int other = grid.cell(u, v);
        const int mine = label[static_cast<size_t>(other)];
        if (mine < 0) continue;
        float& best_m2 = nearest_m2[static_cast<size_t>(mine)];
        best_m2 = std::min(best_m2, (grid.at(other) - grid.at(cell)).squaredNorm());
      }
    }
  }
  for (float& gap : nearest_m2) gap = std::sqrt(gap);
  return nearest_m2;
}

// The partly occluded track that an unowned region belongs to: the region is where the track is
// expected, or a stride from there with only occluders between, and not larger than the surface
// that the track lacks. tracks.size() for none.
size_t FindTrackBehind(const PointGrid& grid, const Region& piece, const std::vector<Region>& owned,
                       const std::vector<int>& home, const std::vector<Track>& tracks,
                       double time_s, const CandidateOptions& options) {
  const MergeOptions& merge = options.merge;
  for (size_t t = 0; t < tracks.size(); ++t) {
    if (home[t] < 0) continue;
    const Region& seen = owned[static_cast<size_t>(home[t])];
    const auto lacks_it = [&](float most_m2) {
      return seen.area_m2 <= merge.hidden_share * most_m2 &&
             seen.area_m2 + piece.area_m2 <= merge.whole_share * most_m2;
    };
    const Eigen::Vector3f off =
        PredictMean_m(tracks[t], time_s, options.prediction.max_prediction_s) - piece.mean_m;
    const bool expected =
        std::abs(off.x()) < merge.expected_aside_m && std::abs(off.z()) < merge.expected_deep_m;
    if (expected && lacks_it(tracks[t].full_m2)) return t;
    // A track that was always partly occluded may be larger than its largest recent surface.
    const Eigen::Vector2f on_floor = grid.OnFloor(off);
    const bool a_stride_off =
        std::abs(on_floor.x()) < merge.stride_m && std::abs(on_floor.y()) < merge.expected_deep_m;
    if (a_stride_off && lacks_it(std::max(tracks[t].full_m2, merge.sideways_m2)) &&
        IsOccludedBetween(grid, seen, piece, options.occlusion))
      return t;
  }
  return tracks.size();
}

// The surface that each track owns.
std::vector<float> MeasureOwned_m2(const PointGrid& grid, const std::vector<int>& owner,
                                   size_t tracks) {
  std::vector<float> owned_m2(tracks, 0.0F);
  for (size_t i = 0; i < owner.size(); ++i) {
    if (owner[i] < 0) continue;
    owned_m2[static_cast<size_t>(owner[i])] += grid.Area(static_cast<int>(i));
  }
  return owned_m2;
}

// Tracks that are lost or partly hidden, as indices.
std::vector<size_t> FindHiddenTracks(const PointGrid& grid, const std::vector<int>& owner,
                                     const std::vector<Track>& tracks,
                                     const MergeOptions& options) {
  const std::vector<float> owned_m2 = MeasureOwned_m2(grid, owner, tracks.size());
  double last_frame_s = -std::numeric_limits<double>::infinity();
  for (const Track& track : tracks) last_frame_s = std::max(last_frame_s, track.last_seen_s);
  std::vector<size_t> hidden;
  for (size_t t = 0; t < tracks.size(); ++t) {
    const bool is_lost = tracks[t].last_seen_s < last_frame_s;
    if (is_lost || owned_m2[t] <= options.hidden_share * tracks[t].full_m2) {
      hidden.push_back(t);
    }
  }
  return hidden;
}

// Whether a region is not of `other`, but may be a hidden track that comes into view again.
bool MayBeHiddenTrack(const PointGrid& grid, const Region& piece, const Track& other,
                      const std::vector<size_t>& hidden, const std::vector<Track>& tracks,
                      double time_s, const CandidateOptions& options) {
  return std::any_of(hidden.begin(), hidden.end(), [&](size_t t) {
    return &tracks[t] != &other && IsExpectedAt(tracks[t], piece, time_s, options.prediction) &&
           IsRatherOf(grid, piece, tracks[t], other, time_s, options);
  });
}

// The largest region of each track, as an index; -1 for none.
std::vector<int> FindLargestOwned(const std::vector<Region>& regions, const std::vector<int>& owner,
                                  size_t tracks) {
  std::vector<int> largest(tracks, -1);
  for (size_t r = 0; r < regions.size(); ++r) {
    const int t = FindMainOwner(regions[r], owner, tracks);
    if (t < 0) continue;
    int& best = largest[static_cast<size_t>(t)];
    if (best < 0 || regions[static_cast<size_t>(best)].area_m2 < regions[r].area_m2) {
      best = static_cast<int>(r);
    }
  }
  return largest;
}

}  // namespace

void ReleaseReturning(const PointGrid& grid, const std::vector<Region>& regions,
                      const std::vector<Track>& tracks, double time_s,
                      const CandidateOptions& options, std::vector<int>& owner) {
  const std::vector<size_t> hidden = FindHiddenTracks(grid, owner, tracks, options.merge);
  if (hidden.empty()) return;
  const std::vector<int> largest = FindLargestOwned(regions, owner, tracks.size());
  for (size_t r = 0; r < regions.size(); ++r) {
    const int t = FindMainOwner(regions[r], owner, tracks.size());
    if (t < 0 || largest[static_cast<size_t>(t)] == static_cast<int>(r)) continue;
    if (!MayBeHiddenTrack(grid, regions[r], tracks[static_cast<size_t>(t)], hidden, tracks, time_s,
                          options))
      continue;
    for (const int cell : regions[r].cells) owner[static_cast<size_t>(cell)] = -1;
  }
}

std::vector<Region> MergePieces(const PointGrid& grid, std::vector<Region> regions,
                                const RoomShape& shape, const std::vector<int>& owner,
                                const std::vector<Track>& tracks, double time_s,
                                const CandidateOptions& options) {
  std::vector<int> label(static_cast<size_t>(grid.cells()), -1);
  std::vector<Region> big, small;
  for (Region& region : regions) {
    const bool whole = region.area_m2 >= options.merge.whole_m2;
    (whole ? big : small).push_back(std::move(region));
    if (!whole) continue;
    for (const int cell : big.back().cells) {
      label[static_cast<size_t>(cell)] = static_cast<int>(big.size()) - 1;
    }
  }
  std::vector<int> owner_of_big;
  std::vector<std::optional<FlatPlane>> plane;
  for (const Region& region : big) {
    owner_of_big.push_back(FindMainOwner(region, owner, tracks.size()));
    plane.push_back(FitWholePlane(region, shape, options.occluder));
  }
  const std::vector<size_t> hidden = FindHiddenTracks(grid, owner, tracks, options.merge);
  for (const Region& piece : small) {
    const int mine = FindMainOwner(piece, owner, tracks.size());
    int best = -1;
    float best_gap = options.merge.reach_m;
    const std::vector<float> gaps_m =
        MeasureGaps_m(grid, piece, label, owner_of_big.size(), options.merge);
    for (size_t i = 0; i < owner_of_big.size(); ++i) {
      if (mine >= 0 && owner_of_big[i] >= 0 && mine != owner_of_big[i]) continue;
      if (plane[i] && StandsBehind(grid, piece, *plane[i], options.occluder)) continue;
      if (mine < 0 && owner_of_big[i] >= 0 &&
          MayBeHiddenTrack(grid, piece, tracks[static_cast<size_t>(owner_of_big[i])], hidden,
                           tracks, time_s, options))
        continue;
      if (gaps_m[i] < best_gap) best_gap = gaps_m[i], best = static_cast<int>(i);
    }
    if (best >= 0) {
      big[static_cast<size_t>(best)] = UniteRegions(grid, big[static_cast<size_t>(best)], piece);
    } else {
      big.push_back(piece);
    }
  }
  return big;
}

std::vector<Region> MergeByTracks(const PointGrid& grid, std::vector<Region> regions,
                                  const std::vector<int>& owner, const std::vector<Track>& tracks,
                                  double time_s, const CandidateOptions& options) {
  std::vector<int> home(tracks.size(), -1);
  std::vector<Region> owned, others;
  for (Region& region : regions) {
    const int track = FindMainOwner(region, owner, tracks.size());
    int* place = track < 0 ? nullptr : &home[static_cast<size_t>(track)];
    if (place == nullptr) {
      others.push_back(std::move(region));
    } else if (*place < 0) {
      *place = static_cast<int>(owned.size());
      owned.push_back(std::move(region));
    } else {
      Region& whole = owned[static_cast<size_t>(*place)];
      whole = UniteRegions(grid, whole, region);
    }
  }
  std::vector<Region> result;
  for (Region& region : others) {
    const size_t t = FindTrackBehind(grid, region, owned, home, tracks, time_s, options);
    if (t == tracks.size()) {
      result.push_back(std::move(region));
    } else {
      Region& whole = owned[static_cast<size_t>(home[t])];
      whole = UniteRegions(grid, whole, region);
    }
  }
  result.insert(result.end(), std::make_move_iterator(owned.begin()),
                std::make_move_iterator(owned.end()));
  std::stable_sort(result.begin(), result.end(),
                   [](const Region& a, const Region& b) { return a.area_m2 > b.area_m2; });
  return result;
}

}  // namespace ossa::people
