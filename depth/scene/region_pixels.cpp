#include "depth/scene/region_pixels_internal.h"

#include <algorithm>
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
  const auto belongs = [&](int x, int y, uint16_t mm) {
    const auto z = static_cast<float>(MetresFromMillimetres(mm));
    float best = 0.06F + DepthTolerance(z);
    bool mine = false;
    const int own = grid.cell(x, y);
    if (place[static_cast<size_t>(own)] == Place::kInside && std::abs(grid.z(own) - z) < best) {
      return true;  // whichever is nearest: all around are the region's
    }
    for (int dy = -1; dy <= 1; ++dy) {
      for (int dx = -1; dx <= 1; ++dx) {
        if (!grid.Contains(x + dx, y + dy)) continue;
        const int cell = grid.cell(x + dx, y + dy);
        // The own cell wins ties against its neighbours.
        const float off = std::abs(grid.z(cell) - z) + (dx != 0 || dy != 0 ? 0.02F : 0.0F);
        if (grid.valid(cell) && off < best)
          best = off, mine = place[static_cast<size_t>(cell)] >= Place::kMember;
      }
    }
    return mine;
  };
  std::vector<int32_t> pixels;
  pixels.reserve(region.cells.size() * static_cast<size_t>(grid.step * grid.step));
  for (int v = low * grid.step; v < std::min(depth.height, (high + 1) * grid.step); ++v) {
    for (int x = 0; x < grid.width; ++x) {
      if (place[static_cast<size_t>(grid.cell(x, v / grid.step))] == Place::kElsewhere) continue;
      for (int u = x * grid.step; u < std::min(depth.width, (x + 1) * grid.step); ++u) {
        const uint16_t mm = depth.at(u, v);
        if (mm > 0 && belongs(x, v / grid.step, mm)) pixels.push_back(v * depth.width + u);
      }
    }
  }
  return pixels;
}

}  // namespace ossa::depth
