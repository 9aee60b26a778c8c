#include "depth/scene/region_pixels.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <optional>

#include "depth/base/cpu_dispatch.h"

namespace ossa::depth {
namespace {

// Relation of a cell to a region: outside, at its border, member, or inside (all valid neighbours
// are members).
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

// Largest depth difference between a pixel and its cell.
float FollowTolerance(float z_m) { return 0.06F + DepthTolerance(z_m); }

// Pixels processed together.
constexpr int kLanes = 4;  // of an SSE2 register
using Lanes = float __attribute__((vector_size(kLanes * sizeof(float))));
using LaneMask = int32_t __attribute__((vector_size(kLanes * sizeof(int32_t))));

// The valid cells around a pixel, which decide whether it belongs to the region.
class Around {
 public:
  Around() = default;
  Around(const PointGrid& grid, const std::vector<Place>& place, int x, int y) {
    for (int dy = -1; dy <= 1; ++dy) {
      for (int dx = -1; dx <= 1; ++dx) {
        if (!grid.Contains(x + dx, y + dy)) continue;
        const int cell = grid.cell(x + dx, y + dy);
        if (!grid.valid(cell)) continue;
        // Ties are won by the pixel's own cell.
        cells_[count_++] = {grid.z(cell), dx != 0 || dy != 0 ? 0.02F : 0.0F,
                            place[static_cast<size_t>(cell)] >= Place::kMember ? ~0 : 0};
      }
    }
  }

  // A pixel belongs to the cell nearest in depth. Classifies up to kLanes pixels, `count` of them
  // valid.
  LaneMask AreMine(const uint16_t* mm, int count) const {
    Lanes z_m = {}, best_m = {};
    for (int l = 0; l < kLanes; ++l) {
      z_m[l] = static_cast<float>(MetresFromMillimetres(l < count ? mm[l] : 0));
      best_m[l] = FollowTolerance(z_m[l]);
    }
    LaneMask mine = {};
    for (size_t i = 0; i < count_; ++i) {
      const Lanes off_m = Distance(cells_[i].z_m, z_m) + cells_[i].handicap_m;
      const LaneMask nearer = off_m < best_m;
      mine = nearer ? LaneMask{} + cells_[i].is_member : mine;
      best_m = nearer ? off_m : best_m;
    }
    return mine;
  }

 private:
  struct Cell {
    float z_m = 0, handicap_m = 0;
    int32_t is_member = 0;  // or all bits set
  };
  static Lanes Distance(float from_m, const Lanes& to_m) {
    const Lanes off_m = from_m - to_m;
    return off_m > 0.0F ? off_m : -off_m;
  }

  std::array<Cell, 9> cells_;
  size_t count_ = 0;
};

// Classification of pixels.
enum Pixel : uint8_t { kNot, kMine, kUndecided };

// Bounding box of a region and its border, first and last cell.
struct CellBox {
  int left = 0, right = -1, top = 0, bottom = -1;
};

CellBox BoundCells(const PointGrid& grid, const Region& region) {
  CellBox box{grid.width, 0, grid.height, 0};
  for (const int cell : region.cells) {
    const int x = cell % grid.width, y = cell / grid.width;
    box = {std::min(box.left, std::max(0, x - 1)),
           std::max(box.right, std::min(grid.width - 1, x + 1)),
           std::min(box.top, std::max(0, y - 1)),
           std::max(box.bottom, std::min(grid.height - 1, y + 1))};
  }
  return box;
}

// Classifies the pixels of the region's box, one row of cells at a time.
class PixelRows {
 public:
  PixelRows(const DepthView& depth, const PointGrid& grid, const std::vector<Place>& place,
            const CellBox& box)
      : depth_(depth),
        grid_(grid),
        place_(place),
        box_(box),
        begin_(box.left * grid.step),
        end_(std::max(begin_, EndOf(box.right))),
        around_(static_cast<size_t>(grid.width)),
        inside_z_m_(static_cast<size_t>(end_ - begin_)),
        otherwise_(inside_z_m_.size()),
        pixels_(inside_z_m_.size()) {}

  int begin() const { return begin_; }

  void Enter(int y) {
    y_ = y;
    size_t i = 0;
    for (int x = box_.left; x <= box_.right; ++x) {
      const int cell = grid_.cell(x, y);
      const Place place = place_[static_cast<size_t>(cell)];
      around_[static_cast<size_t>(x)].reset();
      for (int u = x * grid_.step; u < EndOf(x); ++u, ++i) {
        inside_z_m_[i] = place == Place::kInside ? grid_.z(cell) : kNowhere_m;
        otherwise_[i] = place == Place::kElsewhere ? kNot : kUndecided;
      }
    }
  }

  // Classifies row `v` of the current row of cells: kNot or kMine per pixel.
  const std::vector<uint8_t>& Judge(int v) {
    const uint16_t* mm = depth_.data_mm + static_cast<ptrdiff_t>(v) * depth_.stride;
    FindSure(mm + begin_, inside_z_m_.data(), otherwise_.data(), pixels_.size(), pixels_.data());
    for (int u = NextUndecided(begin_); u < end_; u = NextUndecided(u)) {
      const int x = u / grid_.step;
      DecideByNeighbours(mm, x);
      u = EndOf(x);
    }
    return pixels_;
  }

 private:
  static constexpr float kNowhere_m = -1e9F;  // by definition, far from any measurement

  int EndOf(int x) const { return std::min(depth_.width, (x + 1) * grid_.step); }

  int NextUndecided(int from) const {
    const void* const next =
        std::memchr(pixels_.data() + (from - begin_), kUndecided, static_cast<size_t>(end_ - from));
    if (next == nullptr) return end_;
    return begin_ + static_cast<int>(static_cast<const uint8_t*>(next) - pixels_.data());
  }

  // Inside the region all candidate cells are members: being near the own cell is sufficient.
  // Branch-free, so that the compiler vectorises it.
  OSSA_CPU_DISPATCH static void FindSure(const uint16_t* mm, const float* inside_z_m,
                                         const uint8_t* otherwise, size_t count, uint8_t* pixels) {
    for (size_t u = 0; u < count; ++u) {
      const auto z_m = static_cast<float>(MetresFromMillimetres(mm[u]));
      const int sure = std::abs(inside_z_m[u] - z_m) < FollowTolerance(z_m) ? ~0 : 0;
      const int measured = mm[u] > 0 ? ~0 : 0;
      pixels[u] = static_cast<uint8_t>(((sure & kMine) | (~sure & otherwise[u])) & measured);
    }
  }

  // Decides the remaining pixels of a row of a cell by the neighbouring cells.
  void DecideByNeighbours(const uint16_t* mm, int x) {
    auto& around = around_[static_cast<size_t>(x)];
    if (!around) around.emplace(grid_, place_, x, y_);
    for (int u = x * grid_.step; u < EndOf(x); u += kLanes) {
      const int count = std::min(kLanes, EndOf(x) - u);
      const LaneMask mine = around->AreMine(mm + u, count);
      for (int l = 0; l < count; ++l) {
        uint8_t& pixel = pixels_[static_cast<size_t>(u + l - begin_)];
        if (pixel == kUndecided) pixel = mine[l] != 0 ? kMine : kNot;
      }
    }
  }

  const DepthView depth_;
  const PointGrid& grid_;
  const std::vector<Place>& place_;
  const CellBox box_;
  const int begin_, end_;                      // image columns
  int y_ = 0;                                  // current row of cells
  std::vector<std::optional<Around>> around_;  // of cells requested so far
  std::vector<float> inside_z_m_;              // depth of each pixel's cell, if inside
  std::vector<uint8_t> otherwise_, pixels_;
};

// Appends the indices of a row's pixels that belong to the region; the first pixel has index
// `begin`. Most pixels equal their neighbours.
size_t AppendRow(const std::vector<uint8_t>& row, int begin, int32_t* to) {
  constexpr size_t kEight = sizeof(uint64_t);
  constexpr uint64_t kAllMine = 0x0101010101010101U * kMine;
  size_t kept = 0, u = 0;
  for (; u + kEight <= row.size(); u += kEight) {
    uint64_t eight = 0;
    std::memcpy(&eight, row.data() + u, kEight);
    if (eight == 0) continue;
    const int32_t first = begin + static_cast<int32_t>(u);
    if (eight == kAllMine) {
      for (size_t i = 0; i < kEight; ++i) to[kept + i] = first + static_cast<int32_t>(i);
      kept += kEight;
      continue;
    }
    for (size_t i = 0; i < kEight; ++i) {
      to[kept] = first + static_cast<int32_t>(i);  // branch-free: borders are unpredictable
      kept += row[u + i];
    }
  }
  for (; u < row.size(); ++u) {
    to[kept] = begin + static_cast<int32_t>(u);
    kept += row[u];
  }
  return kept;
}

}  // namespace

std::vector<int32_t> CollectPixels(const DepthFrame& frame, const PointGrid& grid,
                                   const Region& region) {
  const DepthView depth = frame.view();
  const std::vector<Place> place = ClassifyCells(grid, region);
  const CellBox box = BoundCells(grid, region);
  const auto tried =
      place.size() - static_cast<size_t>(std::count(place.begin(), place.end(), Place::kElsewhere));
  // One extra element for a write that is then discarded.
  std::vector<int32_t> pixels(tried * static_cast<size_t>(grid.step * grid.step) + 1);
  size_t kept = 0;
  PixelRows rows(depth, grid, place, box);
  for (int y = box.top; y <= box.bottom; ++y) {
    rows.Enter(y);
    for (int v = y * grid.step; v < std::min(depth.height, (y + 1) * grid.step); ++v) {
      kept += AppendRow(rows.Judge(v), v * depth.width + rows.begin(), pixels.data() + kept);
    }
  }
  pixels.resize(kept);
  return pixels;
}

}  // namespace ossa::depth
