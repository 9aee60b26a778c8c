#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iterator>

#include "depth/scene/pieces.h"

// Pieces of one person of whom something nearer hides the middle.
namespace ossa::depth {
namespace {

// On the straight way in the image from one cell to the other is mostly what is nearer than both,
// and nowhere the room behind them.
bool Covered(const PointGrid& grid, int from, int to) {
  constexpr float kNearer_m = 0.1F, kRoom_m = 0.15F;
  const float near_m = std::min(grid.z(from), grid.z(to)) - kNearer_m;
  const float far_m = std::max(grid.z(from), grid.z(to)) + kRoom_m;
  const int dx = to % grid.width - from % grid.width, dy = to / grid.width - from / grid.width;
  const int steps = std::max(std::abs(dx), std::abs(dy));
  int nearer = 0;
  for (int i = 1; i < steps; ++i) {
    const int cell =
        grid.cell(from % grid.width + dx * i / steps, from / grid.width + dy * i / steps);
    if (!grid.valid(cell)) continue;  // the shadow that the nearer thing casts
    if (grid.z(cell) > far_m) return false;
    nearer += grid.z(cell) < near_m ? 1 : 0;
  }
  return 3 * nearer > steps;
}

// Two pieces of one person, of whom somebody nearer hides the middle.
bool OneBehind(const PointGrid& grid, const Region& a, const Region& b) {
  constexpr float kAside_m = 0.7F, kDeep_m = 0.5F;  // who is hidden in part may be in stride
  const Eigen::Vector2f apart_m = grid.OnFloor(a.mean_m - b.mean_m);
  if (std::abs(apart_m.x()) > kAside_m || std::abs(apart_m.y()) > kDeep_m) return false;
  return HiddenBetween(grid, a, b);
}

// Legs of somebody at a table: broader than a table's own, and about below the body.
bool LegsBelow(const PointGrid& grid, const Region& body, const Region& legs) {
  constexpr float kAside_m = 0.3F, kDeep_m = 0.35F, kFarBelow_m = 0.45F;
  constexpr float kLeast_m2 = 0.02F, kMost_m2 = 0.3F, kBroad_m = 0.09F;
  constexpr float kBody_m2 = 0.12F;
  if (legs.area_m2 < kLeast_m2 || legs.area_m2 > kMost_m2 || body.area_m2 < kBody_m2) return false;
  const Eigen::Vector2f apart_m = grid.OnFloor(body.mean_m - legs.mean_m);
  if (std::abs(apart_m.x()) > kAside_m || std::abs(apart_m.y()) > kDeep_m) return false;
  const float below_m = body.low_m.y() - legs.high_m.y();
  if (below_m < 0 || below_m > kFarBelow_m) return false;
  if (legs.area_m2 < kBroad_m * (legs.high_m.y() - legs.low_m.y())) return false;
  return HiddenBetween(grid, body, legs);
}

}  // namespace

// From the cell of one that is nearest to the other's middle.
bool HiddenBetween(const PointGrid& grid, const Region& a, const Region& b) {
  const auto nearest = [&](const Region& region, const Eigen::Vector3f& to_m) {
    return *std::min_element(region.cells.begin(), region.cells.end(), [&](int p, int q) {
      return (grid.at(p) - to_m).squaredNorm() < (grid.at(q) - to_m).squaredNorm();
    });
  };
  const int from = nearest(a, b.mean_m);
  return Covered(grid, from, nearest(b, grid.at(from)));
}

bool OneAbove(const PointGrid& grid, const Region& a, const Region& b) {
  constexpr float kAside_m = 0.35F, kDeep_m = 0.3F;
  const Eigen::Vector2f apart_m = grid.OnFloor(a.mean_m - b.mean_m);
  if (std::abs(apart_m.x()) > kAside_m || std::abs(apart_m.y()) > kDeep_m) return false;
  const bool a_is_upper = a.mean_m.y() > b.mean_m.y();
  const Region &upper = a_is_upper ? a : b, &lower = a_is_upper ? b : a;
  return upper.mean_m.y() > lower.high_m.y() && lower.mean_m.y() < upper.low_m.y();
}

std::vector<Region> JoinBehind(const PointGrid& grid, std::vector<Region> regions,
                               const std::vector<uint8_t>& arrived, const std::vector<int>& owner,
                               size_t users) {
  constexpr float kPerson_m2 = 0.5F;
  std::vector<Region> others, pieces;
  for (Region& region : regions) {
    const bool newcomer = MostlyArrived(region, arrived) && MostlyOf(region, owner, users) < 0;
    (newcomer ? pieces : others).push_back(std::move(region));
  }
  for (size_t i = 0; i < pieces.size(); ++i) {
    for (size_t k = i + 1; k < pieces.size(); ++k) {
      const Region &a = pieces[i], &b = pieces[k];
      const bool one_person =
          a.area_m2 + b.area_m2 <= kPerson_m2 && (OneBehind(grid, a, b) || OneAbove(grid, a, b));
      if (!one_person) continue;
      pieces[i] = Joined(grid, pieces[i], pieces[k]);
      pieces.erase(pieces.begin() + static_cast<std::ptrdiff_t>(k));
      k = i;
    }
  }
  others.insert(others.end(), std::make_move_iterator(pieces.begin()),
                std::make_move_iterator(pieces.end()));
  return others;
}

std::vector<Region> JoinBelow(const PointGrid& grid, std::vector<Region> regions, size_t users,
                              std::vector<int>& owner) {
  for (size_t i = 0; i < regions.size(); ++i) {
    if (regions[i].cells.empty()) continue;  // somebody's legs by now
    Region whole = regions[i];
    for (size_t k = 0; k < regions.size(); ++k) {
      Region& legs = regions[k];
      if (k == i || legs.cells.empty() || !LegsBelow(grid, regions[i], legs)) continue;
      const int body_of = MostlyOf(regions[i], owner, users);
      const int legs_of = MostlyOf(legs, owner, users);
      if (body_of >= 0 && legs_of >= 0 && body_of != legs_of) continue;
      whole = Joined(grid, whole, legs);
      if (body_of >= 0) {
        for (const int cell : legs.cells) owner[static_cast<size_t>(cell)] = body_of;
      }
      legs.cells.clear();
    }
    regions[i] = std::move(whole);
  }
  std::erase_if(regions, [](const Region& region) { return region.cells.empty(); });
  return regions;
}

}  // namespace ossa::depth
