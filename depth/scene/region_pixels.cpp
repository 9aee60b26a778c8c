#include "depth/scene/region_pixels_internal.h"

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

std::vector<Place> PlacesOf(const PointGrid& grid, const Region& region) {
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
                            place[static_cast<size_t>(cell)] >= Place::kMember};
      }
    }
  }

  // The pixel follows the nearest cell of its depth.
  bool IsMine(uint16_t mm) const {
    const auto z_m = static_cast<float>(MetresFromMillimetres(mm));
    float best_m = 0.06F + DepthTolerance(z_m);
    // Whichever is nearest: all around are the region's.
    if (is_inside_ && std::abs(own_z_m_ - z_m) < best_m) return true;
    bool mine = false;
    for (size_t i = 0; i < count_; ++i) {
      const float off_m = std::abs(cells_[i].z_m - z_m) + cells_[i].handicap_m;
      mine = off_m < best_m ? cells_[i].is_member : mine;
      best_m = std::min(off_m, best_m);
    }
    return mine;
  }

 private:
  struct Cell {
    float z_m = 0, handicap_m = 0;
    bool is_member = false;
  };
  std::array<Cell, 9> cells_;
  size_t count_ = 0;
  float own_z_m_ = 0;
  bool is_inside_ = false;
};

}  // namespace

std::vector<int32_t> PixelsOf(const DepthFrame& frame, const PointGrid& grid,
                              const Region& region) {
  const DepthView depth = frame.view();
  const std::vector<Place> place = PlacesOf(grid, region);
  int low = grid.height, high = 0;
  for (const int cell : region.cells) {
    low = std::min(low, std::max(0, cell / grid.width - 1));
    high = std::max(high, std::min(grid.height - 1, cell / grid.width + 1));
  }
  std::vector<int32_t> pixels;
  pixels.reserve(region.cells.size() * static_cast<size_t>(grid.step * grid.step));
  std::vector<Around> around(static_cast<size_t>(grid.width));
  for (int y = low; y <= high; ++y) {
    for (int x = 0; x < grid.width; ++x) {
      if (place[static_cast<size_t>(grid.cell(x, y))] != Place::kElsewhere)
        around[static_cast<size_t>(x)] = Around(grid, place, x, y);
    }
    for (int v = y * grid.step; v < std::min(depth.height, (y + 1) * grid.step); ++v) {
      for (int x = 0; x < grid.width; ++x) {
        if (place[static_cast<size_t>(grid.cell(x, y))] == Place::kElsewhere) continue;
        for (int u = x * grid.step; u < std::min(depth.width, (x + 1) * grid.step); ++u) {
          const uint16_t mm = depth.at(u, v);
          if (mm > 0 && around[static_cast<size_t>(x)].IsMine(mm))
            pixels.push_back(v * depth.width + u);
        }
      }
    }
  }
  return pixels;
}

}  // namespace ossa::depth
