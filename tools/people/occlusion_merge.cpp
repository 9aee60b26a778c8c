#include "tools/people/occlusion_merge.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iterator>

#include "tools/people/track_prediction.h"

namespace ossa::people {
namespace {

// Whether enough of the image line from one cell to the other is nearer than both, and no cell
// shows the room behind them.
bool IsLineOccluded(const PointGrid& grid, int from, int to, const OcclusionOptions& options) {
  const float near_m = std::min(grid.z(from), grid.z(to)) - options.nearer_m;
  const float far_m = std::max(grid.z(from), grid.z(to)) + options.farther_m;
  const int dx = to % grid.width - from % grid.width, dy = to / grid.width - from / grid.width;
  const int steps = std::max(std::abs(dx), std::abs(dy));
  int nearer = 0;
  for (int i = 1; i < steps; ++i) {
    const int cell =
        grid.cell(from % grid.width + dx * i / steps, from / grid.width + dy * i / steps);
    if (!grid.valid(cell)) continue;  // the shadow that the nearer surface casts
    if (grid.z(cell) > far_m) return false;
    nearer += grid.z(cell) < near_m ? 1 : 0;
  }
  return static_cast<float>(nearer) > options.occluded_share * static_cast<float>(steps);
}

// Regions at both sides of an occluder.
bool AreBesideOccluder(const PointGrid& grid, const Region& a, const Region& b,
                       const OcclusionOptions& options) {
  const Eigen::Vector2f apart_m = grid.OnFloor(a.mean_m - b.mean_m);
  if (std::abs(apart_m.x()) > options.beside_aside_m ||
      std::abs(apart_m.y()) > options.beside_deep_m)
    return false;
  return IsOccludedBetween(grid, a, b, options);
}

// Legs of a person at a table: wider than the table's legs, and about below the body.
bool AreLegsBelow(const PointGrid& grid, const Region& body, const Region& legs,
                  const OcclusionOptions& options) {
  if (legs.area_m2 < options.min_legs_m2 || legs.area_m2 > options.max_legs_m2 ||
      body.area_m2 < options.min_body_m2)
    return false;
  const Eigen::Vector2f apart_m = grid.OnFloor(body.mean_m - legs.mean_m);
  if (std::abs(apart_m.x()) > options.legs_aside_m || std::abs(apart_m.y()) > options.legs_deep_m)
    return false;
  const float below_m = body.low_m.y() - legs.high_m.y();
  if (below_m < 0 || below_m > options.legs_below_m) return false;
  if (legs.area_m2 < options.legs_width_m * (legs.high_m.y() - legs.low_m.y())) return false;
  return IsOccludedBetween(grid, body, legs, options);
}

}  // namespace

// From the cell that is nearest to the other region's centroid.
bool IsOccludedBetween(const PointGrid& grid, const Region& a, const Region& b,
                       const OcclusionOptions& options) {
  const auto nearest = [&](const Region& region, const Eigen::Vector3f& to_m) {
    return *std::min_element(region.cells.begin(), region.cells.end(), [&](int p, int q) {
      return (grid.at(p) - to_m).squaredNorm() < (grid.at(q) - to_m).squaredNorm();
    });
  };
  const int from = nearest(a, b.mean_m);
  return IsLineOccluded(grid, from, nearest(b, grid.at(from)), options);
}

bool IsOneAboveOther(const PointGrid& grid, const Region& a, const Region& b,
                     const OcclusionOptions& options) {
  const Eigen::Vector2f apart_m = grid.OnFloor(a.mean_m - b.mean_m);
  if (std::abs(apart_m.x()) > options.above_aside_m || std::abs(apart_m.y()) > options.above_deep_m)
    return false;
  const bool a_is_upper = a.mean_m.y() > b.mean_m.y();
  const Region &upper = a_is_upper ? a : b, &lower = a_is_upper ? b : a;
  return upper.mean_m.y() > lower.high_m.y() && lower.mean_m.y() < upper.low_m.y();
}

std::vector<Region> MergeBesideOccluder(const PointGrid& grid, std::vector<Region> regions,
                                        const std::vector<uint8_t>& foreground,
                                        const std::vector<int>& owner, size_t tracks,
                                        const CandidateOptions& options) {
  std::vector<Region> others, pieces;
  for (Region& region : regions) {
    const bool is_new =
        MeasureShare(region, foreground) > kMajority && FindMainOwner(region, owner, tracks) < 0;
    (is_new ? pieces : others).push_back(std::move(region));
  }
  for (size_t i = 0; i < pieces.size(); ++i) {
    for (size_t k = i + 1; k < pieces.size(); ++k) {
      const Region &a = pieces[i], &b = pieces[k];
      const bool one_person = a.area_m2 + b.area_m2 <= options.occlusion.person_m2 &&
                              (AreBesideOccluder(grid, a, b, options.occlusion) ||
                               IsOneAboveOther(grid, a, b, options.occlusion));
      if (!one_person) continue;
      pieces[i] = UniteRegions(grid, pieces[i], pieces[k]);
      pieces.erase(pieces.begin() + static_cast<std::ptrdiff_t>(k));
      k = i;
    }
  }
  others.insert(others.end(), std::make_move_iterator(pieces.begin()),
                std::make_move_iterator(pieces.end()));
  return others;
}

std::vector<Region> MergeBelowOccluder(const PointGrid& grid, std::vector<Region> regions,
                                       size_t tracks, std::vector<int>& owner,
                                       const OcclusionOptions& options) {
  for (size_t i = 0; i < regions.size(); ++i) {
    if (regions[i].cells.empty()) continue;  // already merged as legs
    Region whole = regions[i];
    for (size_t k = 0; k < regions.size(); ++k) {
      Region& legs = regions[k];
      if (k == i || legs.cells.empty() || !AreLegsBelow(grid, regions[i], legs, options)) continue;
      const int body_track = FindMainOwner(regions[i], owner, tracks);
      const int legs_track = FindMainOwner(legs, owner, tracks);
      if (body_track >= 0 && legs_track >= 0 && body_track != legs_track) continue;
      whole = UniteRegions(grid, whole, legs);
      if (body_track >= 0) {
        for (const int cell : legs.cells) owner[static_cast<size_t>(cell)] = body_track;
      }
      legs.cells.clear();
    }
    regions[i] = std::move(whole);
  }
  std::erase_if(regions, [](const Region& region) { return region.cells.empty(); });
  return regions;
}

}  // namespace ossa::people
