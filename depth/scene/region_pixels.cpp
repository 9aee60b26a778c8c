#include "depth/scene/region_pixels.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace ossa::depth {
namespace {

// What cells are to a region: theirs, at its rim, or inside, where every valid cell around is
// theirs.
enum class Place : uint8_t { kElsewhere, kRim, kMember, kInside };

bool IsInside(const PointGrid& grid, const std::vector<Place>& place, int x, int y) {
  for (int dy = -1; dy <= 1; ++dy) {
    for (int dx = -1; dx <= 1; ++dx) {
      if (!grid.Contains(x + dx, y + dy)) continue;
      const int cell = grid.cell(x + dx, y + dy);
      if (grid.valid(cell) && place[static_cast<size_t>(cell)] < Place::kMember) return false;
    }
  }
  return true;
}

std::vector<Place> ClassifyCells(const PointGrid& grid, const Region& region) {
  std::vector<Place> place(static_cast<size_t>(grid.cells()), Place::kElsewhere);
  for (const int cell : region.cells) place[static_cast<size_t>(cell)] = Place::kMember;
  for (const int cell : region.cells) {
    const int x = cell % grid.width, y = cell / grid.width;
    for (int dy = -1; dy <= 1; ++dy) {
      for (int dx = -1; dx <= 1; ++dx) {
        if (!grid.Contains(x + dx, y + dy)) continue;
        Place& around = place[static_cast<size_t>(grid.cell(x + dx, y + dy))];
        around = std::max(around, Place::kRim);
      }
    }
    if (IsInside(grid, place, x, y)) place[static_cast<size_t>(cell)] = Place::kInside;
  }
  return place;
}

// Pixels that are judged side by side.
constexpr int kLanes = 4;  // as SSE2 registers hold
using Lanes = float __attribute__((vector_size(kLanes * sizeof(float))));
using LaneMask = int32_t __attribute__((vector_size(kLanes * sizeof(int32_t))));

// The valid cells around a pixel, by which it is told whether it is the region's.
class Around {
 public:
  Around() = default;
  Around(const PointGrid& grid, const std::vector<Place>& place, int x, int y) {
    const int own = grid.cell(x, y);
    own_z_m_ = grid.z(own);
    is_inside_ = place[static_cast<size_t>(own)] == Place::kInside;
    for (int dy = -1; dy <= 1; ++dy) {
      for (int dx = -1; dx <= 1; ++dx) {
        if (!grid.Contains(x + dx, y + dy)) continue;
        const int cell = grid.cell(x + dx, y + dy);
        if (!grid.valid(cell)) continue;
        // The own cell wins ties against its neighbours.
        cells_[count_++] = {grid.z(cell), dx != 0 || dy != 0 ? 0.02F : 0.0F,
                            place[static_cast<size_t>(cell)] >= Place::kMember ? ~0 : 0};
      }
    }
  }

  // A pixel follows the nearest cell of its depth. Of as many pixels as there are lanes, `count` or
  // less: whether they are the region's.
  LaneMask AreMine(const uint16_t* mm, int count) const {
    Lanes z_m = {}, best_m = {};
    for (int l = 0; l < kLanes; ++l) {
      z_m[l] = static_cast<float>(MetresFromMillimetres(l < count ? mm[l] : 0));
      best_m[l] = 0.06F + DepthTolerance(z_m[l]);
    }
    // Whichever is nearest: all around are the region's.
    const LaneMask sure = is_inside_ ? Distance(own_z_m_, z_m) < best_m : LaneMask{};
    if ((sure[0] & sure[1] & sure[2] & sure[3]) != 0) return sure;
    LaneMask mine = {};
    for (size_t i = 0; i < count_; ++i) {
      const Lanes off_m = Distance(cells_[i].z_m, z_m) + cells_[i].handicap_m;
      const LaneMask nearer = off_m < best_m;
      mine = nearer ? LaneMask{} + cells_[i].is_member : mine;
      best_m = nearer ? off_m : best_m;
    }
    return sure | mine;
  }

 private:
  struct Cell {
    float z_m = 0, handicap_m = 0;
    int32_t is_member = 0;  // or all bits
  };
  static Lanes Distance(float from_m, const Lanes& to_m) {
    const Lanes off_m = from_m - to_m;
    return off_m > 0.0F ? off_m : -off_m;
  }

  std::array<Cell, 9> cells_;
  size_t count_ = 0;
  float own_z_m_ = 0;
  bool is_inside_ = false;
};

}  // namespace

std::vector<int32_t> CollectPixels(const DepthFrame& frame, const PointGrid& grid,
                                   const Region& region) {
  const DepthView depth = frame.view();
  const std::vector<Place> place = ClassifyCells(grid, region);
  int low = grid.height, high = 0;
  for (const int cell : region.cells) {
    low = std::min(low, std::max(0, cell / grid.width - 1));
    high = std::max(high, std::min(grid.height - 1, cell / grid.width + 1));
  }
  const auto tried =
      place.size() - static_cast<size_t>(std::count(place.begin(), place.end(), Place::kElsewhere));
  std::vector<int32_t> pixels(tried * static_cast<size_t>(grid.step * grid.step));
  size_t kept = 0;
  std::vector<Around> around(static_cast<size_t>(grid.width));
  for (int y = low; y <= high; ++y) {
    for (int x = 0; x < grid.width; ++x) {
      if (place[static_cast<size_t>(grid.cell(x, y))] != Place::kElsewhere)
        around[static_cast<size_t>(x)] = Around(grid, place, x, y);
    }
    for (int v = y * grid.step; v < std::min(depth.height, (y + 1) * grid.step); ++v) {
      for (int x = 0; x < grid.width; ++x) {
        if (place[static_cast<size_t>(grid.cell(x, y))] == Place::kElsewhere) continue;
        const int end = std::min(depth.width, (x + 1) * grid.step);
        for (int u = x * grid.step; u < end; u += kLanes) {
          const uint16_t* mm = depth.data_mm + static_cast<ptrdiff_t>(v) * depth.stride + u;
          const LaneMask mine = around[static_cast<size_t>(x)].AreMine(mm, end - u);
          for (int l = 0; l < std::min(kLanes, end - u); ++l) {
            pixels[kept] = v * depth.width + u + l;  // no branch: rims are ragged
            kept += mm[l] > 0 && mine[l] != 0 ? 1 : 0;
          }
        }
      }
    }
  }
  pixels.resize(kept);
  return pixels;
}

}  // namespace ossa::depth
