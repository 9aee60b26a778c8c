#include "depth/scene/heads.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <queue>
#include <span>

namespace ossa::depth {
namespace {

constexpr float kHeadRadius_m = 0.085F;  // well inside any head
constexpr float kRing_m = 0.19F;         // well outside any head, above the shoulders
constexpr float kPi = 3.14159265F;

class HeadFinder {
 public:
  HeadFinder(const PointGrid& grid, const Region& region)
      : grid_(grid), member_(static_cast<size_t>(grid.cells()), 0) {
    for (const int cell : region.cells) member_[static_cast<size_t>(cell)] = 1;
  }

  // Share of the disc that is filled times share of the upper ring that is free, times whether
  // shoulders follow below.
  float Score(int cell) const {
    const int x = cell % grid_.width, y = cell / grid_.width;
    const float z = grid_.z(cell);
    // All but one point of the disc, and at most three of the ring.
    const int filled = CountFilled(x, y, z, kHeadRadius_m, disc_, disc_.size(), 1);
    if (filled + 1 < static_cast<int>(disc_.size())) return 0;
    const int taken = CountFilled(x, y, z, kRing_m, ring_, 3, ring_.size());
    if (taken > 3 || GoesOnAbove(x, y, z)) return 0;
    const float below = ShoulderShare(x, y, z);
    return ShareOf(filled, disc_) * (1 - ShareOf(taken, ring_)) * below;
  }

 private:
  struct Direction {
    float cos = 0, sin = 0;
  };
  template <size_t kCount>
  using Directions = std::array<Direction, kCount>;

  template <size_t kCount>
  static Directions<kCount> DirectionsBetween(float from, float to) {
    Directions<kCount> directions;
    for (size_t i = 0; i < kCount; ++i) {
      const float angle =
          from + (to - from) * static_cast<float>(i) / static_cast<float>(kCount - 1);
      directions[i] = {std::cos(angle), std::sin(angle)};
    }
    return directions;
  }

  static float ShareOf(int count, std::span<const Direction> around) {
    return static_cast<float>(count) / static_cast<float>(around.size());
  }

  // As lround: halves away from zero. That one is a call to a library.
  static int Round(float x) {
    const int whole = static_cast<int>(x);
    const float rest = x - static_cast<float>(whole);
    return whole + (rest >= 0.5F ? 1 : 0) - (rest <= -0.5F ? 1 : 0);
  }

  bool Filled(float x, float y, float z) const {
    const int cx = Round(x), cy = Round(y);
    if (!grid_.Contains(cx, cy)) return false;
    const int cell = grid_.cell(cx, cy);
    return member_[static_cast<size_t>(cell)] && std::abs(grid_.z(cell) - z) < 0.15F;
  }

  // How many points around (x, y) are filled; counting ends when more than `most_filled` are, or
  // more than `most_free` are not.
  int CountFilled(int x, int y, float z, float radius_m, std::span<const Direction> around,
                  size_t most_filled, size_t most_free) const {
    const float radius = grid_.CellsOf(radius_m, z);
    size_t filled = 0, free = 0;
    for (const Direction& direction : around) {
      const bool is_filled = Filled(static_cast<float>(x) + radius * direction.cos,
                                    static_cast<float>(y) - radius * direction.sin, z);
      ++(is_filled ? filled : free);
      if (filled > most_filled || free > most_free) break;
    }
    return static_cast<int>(filled);
  }

  // A chest or a hip is as free at its sides as a head, but the body goes on above it.
  bool GoesOnAbove(int x, int y, float z) const {
    int filled = 0;
    for (const float above_m : {0.20F, 0.26F, 0.33F, 0.40F, 0.48F}) {
      const float row = static_cast<float>(y) - grid_.CellsOf(above_m, z);
      for (const float side_m : {-0.06F, 0.0F, 0.06F}) {
        const int cx = Round(static_cast<float>(x) + grid_.CellsOf(side_m, z));
        const int cy = Round(row);
        if (!grid_.Contains(cx, cy)) continue;
        const int cell = grid_.cell(cx, cy);
        filled += member_[static_cast<size_t>(cell)] && std::abs(grid_.z(cell) - z) < 0.35F ? 1 : 0;
      }
    }
    return filled > 5;  // a lifted arm covers one column of three
  }

  // Surface on a row 32 cm below the head's centre, from 17 cm left to 17 cm right. A row under the
  // image's edge counts half, for heads at the bottom, and so does one that something nearer hides
  // altogether, for heads above the back of a seat.
  float ShoulderShare(int x, int y, float z) const {
    constexpr float kNearer_m = 0.1F;
    const float row = static_cast<float>(y) + grid_.CellsOf(0.32F, z);
    if (row >= static_cast<float>(grid_.height)) return 0.5F;
    int filled = 0, hidden = 0;
    constexpr int kSamples = 7;
    for (int i = 0; i < kSamples; ++i) {
      const float side_m = 0.17F * (static_cast<float>(i) / 3.0F - 1.0F);
      const int cx = Round(static_cast<float>(x) + grid_.CellsOf(side_m, z));
      const int cy = static_cast<int>(row);
      if (!grid_.Contains(cx, cy)) continue;
      const int cell = grid_.cell(cx, cy);
      filled += member_[static_cast<size_t>(cell)] && std::abs(grid_.z(cell) - z) < 0.3F ? 1 : 0;
      hidden += grid_.valid(cell) && grid_.z(cell) < z - kNearer_m ? 1 : 0;
    }
    if (filled == 0 && hidden == kSamples) return 0.5F;
    return static_cast<float>(filled) / static_cast<float>(kSamples);
  }

  const PointGrid& grid_;
  std::vector<uint8_t> member_;
  const Directions<12> disc_ = DirectionsBetween<12>(0, 2 * kPi);
  const Directions<14> ring_ = DirectionsBetween<14>(-0.15F * kPi, 1.15F * kPi);
};

}  // namespace

std::vector<HeadBlob> FindHeads(const PointGrid& grid, const Region& region) {
  constexpr float kMinScore = 0.4F, kApart_m = 0.25F;
  const HeadFinder finder(grid, region);
  std::vector<HeadBlob> all;
  for (const int cell : region.cells) {
    const float score = finder.Score(cell);
    if (score >= kMinScore) all.push_back({cell, grid.at(cell), score});
  }
  std::stable_sort(all.begin(), all.end(),
                   [](const HeadBlob& a, const HeadBlob& b) { return a.score > b.score; });
  std::vector<HeadBlob> heads;
  for (const HeadBlob& blob : all) {
    const bool near = std::any_of(heads.begin(), heads.end(), [&](const HeadBlob& head) {
      return (head.position_m - blob.position_m).norm() < kApart_m;
    });
    if (!near) heads.push_back(blob);
  }
  return heads;
}

std::vector<Region> SplitBySeeds(const PointGrid& grid, const Region& region,
                                 const std::vector<Seed>& seeds) {
  // Outlines flicker by so much; and a limb that was missed comes back by so much a frame.
  constexpr float kEdge_m = 0.06F;
  const auto cells = static_cast<size_t>(grid.cells());
  std::vector<uint8_t> member(cells, 0);
  for (const int cell : region.cells) member[static_cast<size_t>(cell)] = 1;
  std::vector<float> distance(cells, std::numeric_limits<float>::infinity());
  std::vector<int> owner(cells, -1);
  using Item = std::pair<float, int>;
  std::priority_queue<Item, std::vector<Item>, std::greater<>> queue;
  for (size_t i = 0; i < seeds.size(); ++i) {
    for (const int cell : seeds[i].cells) {
      if (!member[static_cast<size_t>(cell)]) continue;
      distance[static_cast<size_t>(cell)] = 0;
      owner[static_cast<size_t>(cell)] = static_cast<int>(i);
      queue.push({0.0F, cell});
    }
  }
  while (!queue.empty()) {
    const auto [d, cell] = queue.top();
    queue.pop();
    if (d > distance[static_cast<size_t>(cell)]) continue;
    const int x = cell % grid.width, y = cell / grid.width;
    for (const auto& step : kStepsOverGaps) {
      if (!grid.Contains(x + step[0], y + step[1])) continue;
      const int next = grid.cell(x + step[0], y + step[1]);
      const auto n = static_cast<size_t>(next);
      if (!member[n]) continue;
      Eigen::Vector3f way = grid.at(next) - grid.at(cell);
      way.x() *= 1.5F;  // bodies are tall: sideways costs more than down
      const float jump = Continuous(grid, cell, next) ? 0.0F : 0.3F;
      const float reached = d + way.norm() + jump;
      const int mine = owner[static_cast<size_t>(cell)];
      const Seed& seed = seeds[static_cast<size_t>(mine)];
      if (reached >= distance[n] || reached > seed.reach_m) continue;
      if (seed.barred != nullptr && (*seed.barred)[n] && reached > kEdge_m) continue;
      distance[n] = reached;
      owner[n] = mine;
      queue.push({reached, next});
    }
  }
  std::vector<std::vector<int>> pieces(seeds.size());
  for (const int cell : region.cells) {
    const int i = owner[static_cast<size_t>(cell)];
    if (i >= 0) pieces[static_cast<size_t>(i)].push_back(cell);
  }
  std::vector<Region> result;
  for (auto& piece : pieces) result.push_back(MakeRegion(grid, std::move(piece)));
  return result;
}

}  // namespace ossa::depth
