#include "depth/scene/background.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace ossa::depth {
namespace {

constexpr uint8_t kSaturated = 250;  // frames; a bound, so that counts fit a byte

bool SameSurface(float a_m, float b_m, float tolerance = 1.0F) {
  return std::abs(a_m - b_m) < tolerance * DepthTolerance(b_m);
}

bool IsNearer(float z_m, float before_m, const BackgroundOptions& options) {
  return z_m < before_m - options.foreground_m - DepthTolerance(before_m);
}

// Whether surfaces of nobody are a little nearer than known ones in many parts of the image. Who
// walks past is mostly farther in front of the room.
bool IsNearerAllOver(const PointGrid& grid, const BackgroundState& state,
                     const BackgroundOptions& options) {
  constexpr int kAcross = 8, kDown = 6;     // blocks of the image, by hand
  constexpr int kEnough = 50, kOneIn = 20;  // cells known, and one in this many nearer, by hand
  constexpr int kFewBlocks = 24;            // no unit: fewer may be one person, by hand
  constexpr float kLittle_m = 0.5F;         // by hand: a sensor moves less between two frames
  struct Block {
    int known = 0, nearer = 0;
  };
  std::array<Block, size_t{kAcross} * kDown> blocks{};
  std::vector<size_t> column(static_cast<size_t>(grid.width));  // of blocks, by the cell's
  for (size_t x = 0; x < column.size(); ++x) column[x] = x * kAcross / column.size();
  for (int y = 0; y < grid.height; ++y) {
    Block* const row = &blocks[static_cast<size_t>(y * kDown / grid.height) * kAcross];
    for (int x = 0; x < grid.width; ++x) {
      const int cell = grid.cell(x, y);
      const auto n = static_cast<size_t>(cell);
      if (!grid.valid(cell) || state.steady[n] == 0 || state.claimed[n]) continue;
      Block& block = row[column[static_cast<size_t>(x)]];
      const float z_m = grid.z(cell), before_m = state.surface_m[n];
      ++block.known;
      block.nearer += IsNearer(z_m, before_m, options) && z_m > before_m - kLittle_m ? 1 : 0;
    }
  }
  const auto known =
      std::ranges::count_if(blocks, [](const Block& b) { return b.known > kEnough; });
  const auto nearer = std::ranges::count_if(
      blocks, [](const Block& b) { return b.known > kEnough && b.nearer * kOneIn > b.known; });
  return known >= kFewBlocks &&
         static_cast<double>(nearer) > options.nearer_blocks * static_cast<double>(known);
}

bool SensorMoved(const PointGrid& grid, const BackgroundState& state,
                 const BackgroundOptions& options) {
  if (state.width != grid.width || state.height != grid.height) return false;
  if (IsNearerAllOver(grid, state, options)) return true;
  int known = 0, moved = 0;
  for (int i = 0; i < grid.cells(); ++i) {
    const auto n = static_cast<size_t>(i);
    const bool valid = grid.valid(i), same = SameSurface(grid.z(i), state.surface_m[n]);
    // Non-short-circuiting: half of the readings are slightly farther away, which branch prediction
    // cannot learn.
    const bool is_known = (state.steady[n] >= options.steady_frames) & valid;
    // Nearer surfaces are passing people; a surface that is suddenly farther away is not.
    const bool is_farther = (grid.z(i) > state.surface_m[n]) & !same;
    known += is_known ? 1 : 0;
    moved += (is_known & is_farther) ? 1 : 0;
  }
  return known > 500 && moved > options.moved_share * known;
}

std::vector<uint8_t> FindSurfacesSeenFor(int frames, const PointGrid& grid,
                                         const BackgroundState& state, float tolerance = 1.0F) {
  std::vector<uint8_t> seen(static_cast<size_t>(grid.cells()), 0);
  if (state.width != grid.width || state.height != grid.height) return seen;
  for (int i = 0; i < grid.cells(); ++i) {
    const auto n = static_cast<size_t>(i);
    const bool valid = grid.valid(i);
    const bool same = SameSurface(grid.z(i), state.surface_m[n], tolerance);
    seen[n] = valid & (state.steady[n] >= frames) & same;
  }
  return seen;
}

std::vector<uint8_t> FindForeground(const PointGrid& grid, const BackgroundState& state,
                                    const BackgroundOptions& options) {
  std::vector<uint8_t> foreground(static_cast<size_t>(grid.cells()), 0);
  if (state.width != grid.width || state.height != grid.height) return foreground;
  for (int i = 0; i < grid.cells(); ++i) {
    const auto n = static_cast<size_t>(i);
    const bool valid = grid.valid(i);
    const bool nearer = IsNearer(grid.z(i), state.surface_m[n], options);
    const bool in_front = (state.steady[n] > 0) & nearer;
    const bool alone = state.empty[n] >= options.empty_frames;
    foreground[n] = valid & (in_front | alone);
  }
  return foreground;
}

}  // namespace

void ForgetIfSensorMoved(const PointGrid& grid, BackgroundState& state,
                         const BackgroundOptions& options) {
  if (SensorMoved(grid, state, options)) state = {};
}

void ForgetBackground(const PointGrid& grid, const std::vector<int>& cells, BackgroundState& state,
                      const BackgroundOptions& options) {
  if (state.width != grid.width || state.height != grid.height) return;
  for (const int cell : cells) {
    const auto n = static_cast<size_t>(cell);
    if (state.steady[n] < options.steady_frames && SameSurface(grid.z(cell), state.surface_m[n])) {
      state.steady[n] = 0;
    }
  }
}

void LearnBackground(const PointGrid& grid, const std::vector<uint8_t>& claimed,
                     BackgroundState& state, const BackgroundOptions& options) {
  const auto cells = static_cast<size_t>(grid.cells());
  if (state.width != grid.width || state.height != grid.height) {
    state = {.width = grid.width,
             .height = grid.height,
             .surface_m = std::vector<float>(cells, 0.0F),
             .steady = std::vector<uint8_t>(cells, 0),
             .empty = std::vector<uint8_t>(cells, 0),
             .claimed = {}};
  }
  state.claimed = claimed;
  for (int i = 0; i < grid.cells(); ++i) {
    const auto n = static_cast<size_t>(i);
    const float z = grid.farther(i) ? grid.max_depth_m : grid.z(i);
    if (z <= 0) {
      if (state.surface_m[n] <= 0 && state.empty[n] < kSaturated) ++state.empty[n];
      continue;
    }
    if (state.empty[n] >= options.empty_frames) {
      if (!claimed[n]) --state.empty[n];  // eventually furniture that was put there
      continue;
    }
    if (state.steady[n] > 0 && SameSurface(z, state.surface_m[n])) {
      if (claimed[n]) continue;
      state.surface_m[n] += 0.1F * (z - state.surface_m[n]);
      if (state.steady[n] < kSaturated) ++state.steady[n];
    } else if (!claimed[n] && (z > state.surface_m[n] || state.steady[n] == 0)) {
      state.surface_m[n] = z;  // a farther surface was uncovered
      state.steady[n] = 1;
    } else if (!claimed[n]) {
      --state.steady[n];  // an unclaimed surface in front of it: eventually moved furniture
    }
  }
}

BackgroundMasks CompareWithBackground(const PointGrid& grid, const BackgroundState& state,
                                      const BackgroundOptions& options) {
  BackgroundMasks masks{
      FindSurfacesSeenFor(options.steady_frames, grid, state), FindSurfacesSeenFor(1, grid, state),
      FindSurfacesSeenFor(options.certain_frames, grid, state, options.certain_tolerance),
      FindForeground(grid, state, options)};
  const auto measured = std::ranges::count_if(
      grid.point_m, [](const Eigen::Vector3f& point_m) { return point_m.z() > 0; });
  const auto certain = std::ranges::count(masks.certain, uint8_t{1});
  masks.certain_share =
      static_cast<double>(certain) / static_cast<double>(std::max<long>(1, measured));
  return masks;
}

float MeasureForegroundArea_m2(const PointGrid& grid, const std::vector<int>& cells,
                               const std::vector<uint8_t>& foreground) {
  float area_m2 = 0;
  for (const int cell : cells) {
    const int x = cell % grid.width, y = cell / grid.width;
    bool all = grid.Contains(x - 1, y - 1) && grid.Contains(x + 1, y + 1);
    for (int i = 0; i < 9 && all; ++i)
      all = foreground[static_cast<size_t>(grid.cell(x - 1 + i % 3, y - 1 + i / 3))] != 0;
    area_m2 += all ? grid.Area(cell) : 0.0F;
  }
  return area_m2;
}

}  // namespace ossa::depth
