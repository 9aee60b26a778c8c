#include "depth/scene/region_pixels.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace ossa::depth {
namespace {

constexpr double kFocal_px = 300.0;

// Oblique, intersecting surfaces with sensor noise and holes.
DepthFrame Ragged(int width, int height) {
  std::mt19937 draw(7);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  DepthFrame frame;
  frame.camera = {width, height, kFocal_px, kFocal_px, width / 2.0, height / 2.0};
  frame.depth_mm.resize(static_cast<size_t>(width) * static_cast<size_t>(height));
  for (size_t p = 0; p < frame.depth_mm.size(); ++p) {
    const double u = static_cast<double>(p % static_cast<size_t>(width)) / width;
    const double v = static_cast<double>(p / static_cast<size_t>(width)) / height;
    const bool before = std::abs(u - 0.5) + 0.1 * std::sin(20.0 * v) < 0.25;
    const double z_mm = (before ? 1500.0 + 300.0 * v : 1400.0 + 900.0 * u) + 60.0 * unit(draw);
    frame.depth_mm[p] = unit(draw) < 0.1 ? uint16_t{0} : static_cast<uint16_t>(z_mm);
  }
  return frame;
}

// The definition: a pixel belongs to the valid surrounding cell nearest in depth, its own on ties,
// within 6 cm plus the sensor's tolerance.
bool IsMine(const DepthFrame& frame, const PointGrid& grid, const std::vector<bool>& member, int u,
            int v) {
  const uint16_t mm = frame.view().at(u, v);
  if (mm == 0) return false;
  const auto z_m = static_cast<float>(MetresFromMillimetres(mm));
  float best_m = 0.06F + DepthTolerance(z_m);
  bool is_mine = false;
  for (int i = 0; i < 9; ++i) {
    const int x = u / grid.step + i % 3 - 1, y = v / grid.step + i / 3 - 1;
    if (!grid.Contains(x, y) || !grid.valid(grid.cell(x, y))) continue;
    const float off_m = std::abs(grid.z(grid.cell(x, y)) - z_m) + (i == 4 ? 0.0F : 0.02F);
    if (off_m >= best_m) continue;
    best_m = off_m;
    is_mine = member[static_cast<size_t>(grid.cell(x, y))];
  }
  return is_mine;
}

std::vector<int32_t> OneByOne(const DepthFrame& frame, const PointGrid& grid,
                              const Region& region) {
  std::vector<bool> member(static_cast<size_t>(grid.cells()));
  for (const int cell : region.cells) member[static_cast<size_t>(cell)] = true;
  std::vector<int32_t> pixels;
  for (int v = 0; v < frame.camera.height; ++v) {
    for (int u = 0; u < frame.camera.width; ++u) {
      if (IsMine(frame, grid, member, u, v)) pixels.push_back(v * frame.camera.width + u);
    }
  }
  return pixels;
}

// Cells of one, two and four pixels, including cells cut by the image border.
TEST(RegionPixels, BelongToTheCellNearestInDepth) {
  for (const auto& [width, height] : {std::pair{160, 120}, {321, 243}, {640, 480}, {653, 481}}) {
    const DepthFrame frame = Ragged(width, height);
    const PointGrid grid = MakePointGrid(frame.view(), frame.camera, 6.0F);
    const std::vector<uint8_t> ignore(static_cast<size_t>(grid.cells()), 0);
    const auto regions = FindConnectedRegions(grid, ignore, 0.0F);
    ASSERT_GT(regions.size(), 1U);
    for (const Region& region : {regions.front(), regions[1], regions.back()}) {
      EXPECT_EQ(CollectPixels(frame, grid, region), OneByOne(frame, grid, region)) << width;
    }
  }
}

TEST(RegionPixels, AreEmptyForNoCells) {
  const DepthFrame frame = Ragged(160, 120);
  const PointGrid grid = MakePointGrid(frame.view(), frame.camera, 6.0F);
  EXPECT_TRUE(CollectPixels(frame, grid, MakeRegion(grid, {})).empty());
}

TEST(ConnectedRegions, AreSortedBySizeWithAscendingUniqueCells) {
  const DepthFrame frame = Ragged(320, 240);
  const PointGrid grid = MakePointGrid(frame.view(), frame.camera, 6.0F);
  std::vector<uint8_t> taken(static_cast<size_t>(grid.cells()), 0);
  for (int x = 0; x < grid.width; ++x) taken[static_cast<size_t>(grid.cell(x, 40))] = 1;
  const auto regions = FindConnectedRegions(grid, taken, 0.0F);
  for (const Region& region : regions) {
    EXPECT_TRUE(std::is_sorted(region.cells.begin(), region.cells.end()));
    for (const int cell : region.cells) EXPECT_EQ(taken[static_cast<size_t>(cell)]++, 0);
  }
  for (int cell = 0; cell < grid.cells(); ++cell) {
    EXPECT_EQ(taken[static_cast<size_t>(cell)] != 0, grid.valid(cell) || cell / grid.width == 40);
  }
  EXPECT_TRUE(std::is_sorted(regions.begin(), regions.end(),
                             [](const auto& a, const auto& b) { return a.area_m2 > b.area_m2; }));
}

// Cells in any order give the same region.
TEST(ConnectedRegions, UniteIntoOne) {
  const DepthFrame frame = Ragged(160, 120);
  const PointGrid grid = MakePointGrid(frame.view(), frame.camera, 6.0F);
  const Region united =
      UniteRegions(grid, MakeRegion(grid, {900, 3, 41}), MakeRegion(grid, {40, 2000}));
  EXPECT_EQ(united.cells, (std::vector<int>{3, 40, 41, 900, 2000}));
}

}  // namespace
}  // namespace ossa::depth
