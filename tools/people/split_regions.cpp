#include "tools/people/split_regions.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <queue>
#include <span>
#include <utility>

#include "tools/people/track_prediction.h"

namespace ossa::people {
namespace {

// The nearest seed to a head, if they may be of the same person; -1 for none.
int FindHeadOwner(const PointGrid& grid, const HeadBlob& head, std::span<const Seed> seeds,
                  float max_step_m) {
  int mine = -1;
  float nearest_m = max_step_m;
  for (size_t i = 0; i < seeds.size(); ++i) {
    for (const int cell : seeds[i].cells) {
      const float off_m = (grid.at(cell) - head.position_m).norm();
      if (off_m < nearest_m) nearest_m = off_m, mine = static_cast<int>(i);
    }
  }
  return mine;
}

// A region with one person is not split, unless its surface is too large for one, or it has too
// many background cells.
bool IsOnePerson(const Region& region, const Seed& seed, const SeedOptions& options) {
  if (region.area_m2 > options.one_person_m2) return false;
  if (seed.background == nullptr) return true;
  return std::count_if(region.cells.begin(), region.cells.end(), [&](int cell) {
           return (*seed.background)[static_cast<size_t>(cell)] != 0;
         }) < options.one_person_background_cells;
}

// The length of a path with one more step; depth discontinuities and horizontal steps add to it.
float AddStep_m(const PointGrid& grid, float way_m, int from, int to, const SeedOptions& options) {
  Eigen::Vector3f step_m = grid.at(to) - grid.at(from);
  step_m.x() *= options.sideways;
  return way_m + step_m.norm() + (Continuous(grid, from, to) ? 0.0F : options.jump_cost_m);
}

// Whether a seed may grow to a cell at this distance over the surface.
bool MayReach(const Seed& seed, int cell, float way_m, const SeedOptions& options) {
  if (way_m > seed.reach_m) return false;
  const bool enters = seed.background != nullptr && (*seed.background)[static_cast<size_t>(cell)];
  return !enters || way_m <= options.background_rim_m;
}

// The seed with the shortest path over the surface to each cell of a region. Dijkstra 1959, from
// all seeds at once.
class SeedGrowth {
 public:
  SeedGrowth(const PointGrid& grid, const Region& region, const std::vector<Seed>& seeds,
             const SeedOptions& options)
      : grid_(grid),
        seeds_(seeds),
        options_(options),
        member_(static_cast<size_t>(grid.cells()), 0),
        way_m_(member_.size(), std::numeric_limits<float>::infinity()),
        nearest_(member_.size(), -1) {
    for (const int cell : region.cells) member_[static_cast<size_t>(cell)] = 1;
  }

  // The seed of each cell as an index; -1 beyond reach, and outside the region. Most cells of the
  // result are seed cells; these bypass the queue, which would give them in ascending order.
  std::vector<int> Run() {
    const std::vector<int> own = EnterSeeds();
    for (const int cell : own) GrowFrom(cell);
    while (!queue_.empty()) {
      const auto [done_m, cell] = queue_.top();
      queue_.pop();
      if (done_m <= way_m_[static_cast<size_t>(cell)]) GrowFrom(cell);
    }
    return std::move(nearest_);
  }

 private:
  // The seeds' cells, ascending.
  std::vector<int> EnterSeeds() {
    std::vector<int> own;
    for (size_t i = 0; i < seeds_.size(); ++i) {
      for (const int cell : seeds_[i].cells) {
        if (!member_[static_cast<size_t>(cell)]) continue;
        way_m_[static_cast<size_t>(cell)] = 0.0F;
        nearest_[static_cast<size_t>(cell)] = static_cast<int>(i);
        own.push_back(cell);
      }
    }
    std::sort(own.begin(), own.end());
    return own;
  }

  void GrowFrom(int cell) {
    const int x = cell % grid_.width, y = cell / grid_.width;
    const float done_m = way_m_[static_cast<size_t>(cell)];
    const int seed = nearest_[static_cast<size_t>(cell)];
    for (const auto& step : depth::kStepsOverGaps) {
      if (!grid_.Contains(x + step[0], y + step[1])) continue;
      const int next = grid_.cell(x + step[0], y + step[1]);
      float& way_m = way_m_[static_cast<size_t>(next)];
      // No longer path can be shorter; this skips most neighbours.
      if (!member_[static_cast<size_t>(next)] || way_m <= done_m) continue;
      const float reached_m = AddStep_m(grid_, done_m, cell, next, options_);
      if (reached_m >= way_m) continue;
      if (!MayReach(seeds_[static_cast<size_t>(seed)], next, reached_m, options_)) continue;
      way_m = reached_m;
      nearest_[static_cast<size_t>(next)] = seed;
      queue_.push({reached_m, next});
    }
  }

  using Item = std::pair<float, int>;

  const PointGrid& grid_;
  const std::vector<Seed>& seeds_;
  const SeedOptions& options_;
  std::vector<uint8_t> member_;
  std::vector<float> way_m_;
  std::vector<int> nearest_;
  std::priority_queue<Item, std::vector<Item>, std::greater<>> queue_;
};

// What is beyond the reach of every head may be a person whose head was not detected; beside a
// track it may be a part of that person.
std::vector<Region> AddRest(const PointGrid& grid, const Region& region,
                            std::span<const Seed> seeds, std::vector<Region> pieces,
                            const CandidateOptions& options) {
  const auto is_of_track = [](const Seed& seed) { return seed.background != nullptr; };
  if (std::any_of(seeds.begin(), seeds.end(), is_of_track)) return pieces;
  std::vector<uint8_t> ignore(static_cast<size_t>(grid.cells()), 1);
  for (const int cell : region.cells) ignore[static_cast<size_t>(cell)] = 0;
  for (const Region& piece : pieces) {
    for (const int cell : piece.cells) ignore[static_cast<size_t>(cell)] = 1;
  }
  for (Region& rest : FindConnectedRegions(grid, ignore, options.min_area_m2)) {
    if (IsPersonSized(rest, options)) pieces.push_back(std::move(rest));
  }
  return pieces;
}

}  // namespace

std::vector<Region> SplitBySeeds(const PointGrid& grid, const Region& region,
                                 const std::vector<Seed>& seeds, const SeedOptions& options) {
  const std::vector<int> nearest = SeedGrowth(grid, region, seeds, options).Run();
  std::vector<std::vector<int>> pieces(seeds.size());
  for (const int cell : region.cells) {
    const int seed = nearest[static_cast<size_t>(cell)];
    if (seed >= 0) pieces[static_cast<size_t>(seed)].push_back(cell);
  }
  std::vector<Region> result;
  for (auto& piece : pieces) result.push_back(MakeRegion(grid, std::move(piece)));
  return result;
}

std::vector<int> CollectHeadCells(const PointGrid& grid, const Region& region,
                                  const Eigen::Vector3f& head_m, const SeedOptions& options) {
  std::vector<int> seed;
  for (const int cell : region.cells) {
    if ((grid.at(cell) - head_m).norm() < options.head_radius_m) seed.push_back(cell);
  }
  return seed;
}

bool IsPersonSized(const Region& region, const CandidateOptions& options) {
  const Eigen::Vector3f size = region.high_m - region.low_m;
  const float length = std::max(size.y(), std::max(size.x(), size.z()));
  return region.area_m2 >= options.min_area_m2 && length >= options.min_height_m &&
         region.cells.size() >= options.min_cells;
}

bool IsForegroundPersonSized(const Region& region, const std::vector<uint8_t>& foreground,
                             const CandidateOptions& options) {
  CandidateOptions less = options;
  less.min_area_m2 = options.min_foreground_area_m2;
  less.min_height_m = options.min_foreground_height_m;
  return IsPersonSized(region, less) && MeasureShare(region, foreground) > kMajority;
}

std::vector<Seed> FindSeeds(const PointGrid& grid, const Region& region,
                            std::span<const HeadBlob> heads, const std::vector<int>& owner,
                            size_t tracks, const std::vector<uint8_t>& background,
                            const CandidateOptions& options) {
  std::vector<Seed> seeds;
  for (auto& cells : CollectOverlaps(region, owner, tracks)) {
    if (cells.size() >= options.seeds.min_track_cells)
      seeds.push_back({std::move(cells), options.seeds.growth_m, &background});
  }
  const size_t known = seeds.size();
  std::vector<uint8_t> has_head(known, 0);
  for (const HeadBlob& head : heads) {
    const int mine =
        FindHeadOwner(grid, head, std::span(seeds).first(known), options.seeds.owner_step_m);
    // A person has one head, and it moves: the best head at a track belongs to that track. Others
    // belong to other people, unless they lie within the track's cells.
    std::vector<int> seed = CollectHeadCells(grid, region, head.position_m, options.seeds);
    if (mine >= 0 && !has_head[static_cast<size_t>(mine)]) {
      has_head[static_cast<size_t>(mine)] = 1;
      continue;
    }
    const auto taken = std::count_if(
        seed.begin(), seed.end(), [&](int cell) { return owner[static_cast<size_t>(cell)] >= 0; });
    if (2 * taken < static_cast<long>(seed.size()))
      seeds.push_back({std::move(seed), options.seeds.max_reach_m, nullptr});
  }
  return seeds;
}

std::vector<Region> CutAtSeeds(const PointGrid& grid, const Region& region, std::vector<Seed> seeds,
                               const CandidateOptions& options) {
  while (true) {
    if (seeds.empty() || (seeds.size() == 1 && IsOnePerson(region, seeds[0], options.seeds)))
      return {region};
    std::vector<Region> pieces = SplitBySeeds(grid, region, seeds, options.seeds);
    if (seeds.size() == 1) return AddRest(grid, region, seeds, std::move(pieces), options);
    size_t least = 0;
    for (size_t i = 1; i < pieces.size(); ++i) {
      if (pieces[i].area_m2 < pieces[least].area_m2) least = i;
    }
    if (IsPersonSized(pieces[least], options))
      return AddRest(grid, region, seeds, std::move(pieces), options);
    seeds.erase(seeds.begin() + static_cast<std::ptrdiff_t>(least));
  }
}

}  // namespace ossa::people
