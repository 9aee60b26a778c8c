#include "tools/people/overhead.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace ossa::people {
namespace {

float HeightOf(const PointGrid& grid, const FloorPlane& floor, int cell) {
  return static_cast<float>(floor.HeightOf(grid.at(cell).cast<double>()));
}

// Shares of the points of a circle around a cell, [0, 1].
struct Circle {
  float level = 0;  // at the cell's height
  float lower = 0;  // lower by the height of a neck, or not of the region
};

class TopFinder {
 public:
  TopFinder(const PointGrid& grid, const FloorPlane& floor, const Region& region,
            const OverheadOptions& options)
      : grid_(grid), options_(options), height_m_(static_cast<size_t>(grid.cells()), 0.0F) {
    for (const int cell : region.cells) height_m_[Index(cell)] = HeightOf(grid, floor, cell);
  }

  // Level share of the disc times lower share of the ring; 0 outside the heights of heads.
  float Score(int cell) const {
    const float height_m = height_m_[Index(cell)];
    if (height_m < options_.min_head_m || height_m > options_.max_head_m) return 0;
    const float disc = SampleCircle(cell, options_.inner_radius_m).level;
    if (disc < options_.min_disc) return 0;
    return disc * SampleCircle(cell, options_.outer_radius_m).lower;
  }
  float height_m(int cell) const { return height_m_[Index(cell)]; }

 private:
  static size_t Index(int cell) { return static_cast<size_t>(cell); }

  Circle SampleCircle(int cell, float radius_m) const {
    constexpr int kPoints = 16;  // by hand: 2.7 to 7.9 cm apart, as cells are
    const float top_m = height_m_[Index(cell)];
    const float radius = grid_.CellsOf(radius_m, grid_.z(cell));
    int level = 0, lower = 0;
    for (int i = 0; i < kPoints; ++i) {
      const float angle = 2 * std::numbers::pi_v<float> * static_cast<float>(i) / kPoints;
      const auto x = std::lround(static_cast<float>(cell % grid_.width) + radius * std::cos(angle));
      const auto y = std::lround(static_cast<float>(cell / grid_.width) + radius * std::sin(angle));
      const bool inside = grid_.Contains(static_cast<int>(x), static_cast<int>(y));
      const float there_m =
          inside ? height_m_[Index(grid_.cell(static_cast<int>(x), static_cast<int>(y)))] : 0.0F;
      level += std::abs(there_m - top_m) < options_.level_m ? 1 : 0;
      lower += there_m < top_m - options_.lower_m ? 1 : 0;
    }
    return {static_cast<float>(level) / kPoints, static_cast<float>(lower) / kPoints};
  }

  const PointGrid& grid_;
  const OverheadOptions& options_;
  std::vector<float> height_m_;  // above the floor; 0 outside the region
};

}  // namespace

std::vector<Region> FindRegionsFromAbove(const PointGrid& grid, const FloorPlane& floor,
                                         std::span<const uint8_t> ignored, float speck_m2,
                                         const OverheadOptions& options) {
  std::vector<uint8_t> done(ignored.begin(), ignored.end());
  for (int cell = 0; cell < grid.cells(); ++cell) {
    if (!grid.valid(cell) || HeightOf(grid, floor, cell) < options.foot_m)
      done[static_cast<size_t>(cell)] = 1;
  }
  std::vector<Region> regions;
  for (int start = 0; start < grid.cells(); ++start) {
    if (done[static_cast<size_t>(start)]) continue;
    std::vector<int> cells(1, start);
    done[static_cast<size_t>(start)] = 1;
    for (size_t i = 0; i < cells.size(); ++i) {
      const int x = cells[i] % grid.width, y = cells[i] / grid.width;
      for (const auto& step : depth::kStepsOverGaps) {
        if (!grid.Contains(x + step[0], y + step[1])) continue;
        const int next = grid.cell(x + step[0], y + step[1]);
        if (done[static_cast<size_t>(next)]) continue;
        done[static_cast<size_t>(next)] = 1;
        cells.push_back(next);
      }
    }
    Region region = depth::MakeRegion(grid, std::move(cells));
    if (region.area_m2 >= speck_m2) regions.push_back(std::move(region));
  }
  std::stable_sort(regions.begin(), regions.end(),
                   [](const Region& a, const Region& b) { return a.area_m2 > b.area_m2; });
  return regions;
}

std::vector<HeadBlob> FindHeadsFromAbove(const PointGrid& grid, const FloorPlane& floor,
                                         const Region& region, const OverheadOptions& options) {
  const TopFinder tops(grid, floor, region, options);
  std::vector<HeadBlob> all;
  for (const int cell : region.cells) {
    const float score = tops.Score(cell);
    if (score >= options.min_score) all.push_back({cell, grid.at(cell), score});
  }
  // Of equal scores the highest cell: the centre of a head is its top.
  std::stable_sort(all.begin(), all.end(), [&](const HeadBlob& a, const HeadBlob& b) {
    return a.score != b.score ? a.score > b.score : tops.height_m(a.cell) > tops.height_m(b.cell);
  });
  return SuppressNearbyHeads(all, [&](const HeadBlob& a, const HeadBlob& b) {
    return grid.OnFloor(b.position_m - a.position_m).norm() < options.min_distance_m;
  });
}

Region KeepWithinReach(const PointGrid& grid, const Region& region, const HeadBlob& head,
                       const OverheadOptions& options) {
  const auto off_m = [&](int cell) { return grid.OnFloor(grid.at(cell) - head.position_m).norm(); };
  std::vector<uint8_t> open(static_cast<size_t>(grid.cells()), 0);
  for (const int cell : region.cells) {
    open[static_cast<size_t>(cell)] = off_m(cell) <= options.reach_m;
  }
  std::vector<int> kept(1, head.cell);
  open[static_cast<size_t>(head.cell)] = 0;
  for (size_t i = 0; i < kept.size(); ++i) {
    const int cell = kept[i], x = cell % grid.width, y = cell / grid.width;
    const bool at_trunk = off_m(cell) <= options.trunk_m;
    for (const auto& step : depth::kStepsOverGaps) {
      if (!grid.Contains(x + step[0], y + step[1])) continue;
      const int next = grid.cell(x + step[0], y + step[1]);
      if (!open[static_cast<size_t>(next)]) continue;
      const bool stays_at_trunk = at_trunk && off_m(next) <= options.trunk_m;
      if (!depth::Continuous(grid, cell, next) && !stays_at_trunk) continue;
      open[static_cast<size_t>(next)] = 0;
      kept.push_back(next);
    }
  }
  std::sort(kept.begin(), kept.end());
  return depth::MakeRegion(grid, std::move(kept));
}

}  // namespace ossa::people
