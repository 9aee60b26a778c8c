#include "tools/people/head_detector.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <span>

namespace ossa::people {
namespace {

using std::numbers::pi_v;

class HeadFinder {
 public:
  HeadFinder(const PointGrid& grid, const Region& region, const HeadOptions& options)
      : grid_(grid), options_(options), member_(static_cast<size_t>(grid.cells()), 0) {
    for (const int cell : region.cells) member_[static_cast<size_t>(cell)] = 1;
  }

  // Filled share of the disc times free share of the upper ring times filled share of the
  // shoulders' row.
  float Score(int cell) const {
    const int x = cell % grid_.width, y = cell / grid_.width;
    const float z = grid_.z(cell);
    // At most one point of the disc may be free.
    const int filled = CountFilled(x, y, z, options_.inner_radius_m, disc_, disc_.size(), 1);
    if (filled + 1 < static_cast<int>(disc_.size())) return 0;
    const int taken = CountFilled(x, y, z, options_.outer_radius_m, ring_,
                                  static_cast<size_t>(options_.max_ring), ring_.size());
    if (taken > options_.max_ring || ContinuesAbove(x, y, z)) return 0;
    const float below = MeasureShoulders(x, y, z);
    return Share(filled, disc_) * (1 - Share(taken, ring_)) * below;
  }

 private:
  struct Direction {
    float cos = 0, sin = 0;
  };
  template <size_t kCount>
  using Directions = std::array<Direction, kCount>;

  template <size_t kCount>
  static Directions<kCount> MakeDirections(float from, float to) {
    Directions<kCount> directions;
    for (size_t i = 0; i < kCount; ++i) {
      const float angle =
          from + (to - from) * static_cast<float>(i) / static_cast<float>(kCount - 1);
      directions[i] = {std::cos(angle), std::sin(angle)};
    }
    return directions;
  }

  static float Share(int count, std::span<const Direction> around) {
    return static_cast<float>(count) / static_cast<float>(around.size());
  }

  // As lround, which is slow because it is not inlined: halves away from zero.
  static int Round(float x) {
    const int whole = static_cast<int>(x);
    const float rest = x - static_cast<float>(whole);
    return whole + (rest >= 0.5F ? 1 : 0) - (rest <= -0.5F ? 1 : 0);
  }

  bool Filled(float x, float y, float z) const {
    const int cx = Round(x), cy = Round(y);
    if (!grid_.Contains(cx, cy)) return false;
    const int cell = grid_.cell(cx, cy);
    return member_[static_cast<size_t>(cell)] &&
           std::abs(grid_.z(cell) - z) < options_.max_depth_step_m;
  }

  // The number of filled points around (x, y); stops early above `most_filled` filled or
  // `most_free` free ones, where the score is 0 anyway.
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

  // Rejects chests and hips: they are as free at their sides, but the body continues above.
  bool ContinuesAbove(int x, int y, float z) const {
    int filled = 0;
    for (const float above_m : {0.20F, 0.26F, 0.33F, 0.40F, 0.48F}) {
      const float row = static_cast<float>(y) - grid_.CellsOf(above_m, z);
      for (const float side_m : {-0.06F, 0.0F, 0.06F}) {
        const int cx = Round(static_cast<float>(x) + grid_.CellsOf(side_m, z));
        const int cy = Round(row);
        if (!grid_.Contains(cx, cy)) continue;
        const int cell = grid_.cell(cx, cy);
        filled += member_[static_cast<size_t>(cell)] &&
                          std::abs(grid_.z(cell) - z) < options_.max_body_depth_step_m
                      ? 1
                      : 0;
      }
    }
    return filled > options_.max_above;
  }

  // Filled share of the shoulders' row. A row below the image counts half, for heads at the lower
  // border, and so does a completely occluded one, for heads above the back of a seat.
  float MeasureShoulders(int x, int y, float z) const {
    const float row = static_cast<float>(y) + grid_.CellsOf(options_.shoulders_below_m, z);
    if (row >= static_cast<float>(grid_.height)) return 0.5F;
    int filled = 0, hidden = 0;
    constexpr int kSamples = 7;  // 5.7 cm apart: by hand, about as far as cells are at 6 m
    for (int i = 0; i < kSamples; ++i) {
      const float side_m = options_.shoulders_half_m * (static_cast<float>(i) / 3.0F - 1.0F);
      const int cx = Round(static_cast<float>(x) + grid_.CellsOf(side_m, z));
      const int cy = static_cast<int>(row);
      if (!grid_.Contains(cx, cy)) continue;
      const int cell = grid_.cell(cx, cy);
      filled += member_[static_cast<size_t>(cell)] &&
                        std::abs(grid_.z(cell) - z) < options_.max_shoulder_depth_step_m
                    ? 1
                    : 0;
      hidden += grid_.valid(cell) && grid_.z(cell) < z - options_.occluder_m ? 1 : 0;
    }
    if (filled == 0 && hidden == kSamples) return 0.5F;
    return static_cast<float>(filled) / static_cast<float>(kSamples);
  }

  const PointGrid& grid_;
  const HeadOptions& options_;
  std::vector<uint8_t> member_;
  const Directions<12> disc_ = MakeDirections<12>(0, 2 * pi_v<float>);
  const Directions<14> ring_ = MakeDirections<14>(-0.15F * pi_v<float>, 1.15F * pi_v<float>);
};

}  // namespace

std::vector<HeadBlob> FindHeads(const PointGrid& grid, const Region& region,
                                const HeadOptions& options) {
  const HeadFinder finder(grid, region, options);
  std::vector<HeadBlob> all;
  for (const int cell : region.cells) {
    const float score = finder.Score(cell);
    if (score >= options.min_score) all.push_back({cell, grid.at(cell), score});
  }
  std::stable_sort(all.begin(), all.end(),
                   [](const HeadBlob& a, const HeadBlob& b) { return a.score > b.score; });
  return SuppressNearbyHeads(all, [&](const HeadBlob& a, const HeadBlob& b) {
    return (b.position_m - a.position_m).norm() < options.min_distance_m;
  });
}

}  // namespace ossa::people
