#pragma once
#include <cstdint>
#include <vector>

#include "depth/scene/point_grid.h"

namespace ossa::depth {

/// The farthest steady surface seen in each cell. No empty room is needed: a person who moves
/// uncovers what is behind, and whatever nobody claims for a second becomes background.
struct BackgroundState {
  int width = 0, height = 0;
  std::vector<float> surface_m;  // z of the surface, 0 = none known
  std::vector<uint8_t> steady;   // frames it was seen there, saturating
};

struct BackgroundOptions {
  int steady_frames = 20;    // until a surface counts as background
  double moved_share = 0.5;  // of known cells that disagree at once: the sensor was moved
};

/// Learns from one frame. `claimed` (one entry a cell) marks the cells of people: never learned.
void LearnBackground(const PointGrid& grid, const std::vector<uint8_t>& claimed,
                     BackgroundState& state, const BackgroundOptions& options = {});

/// True per cell where the surface is seen that was there in the frame before, nobody's: it is no
/// part of anybody who comes near.
std::vector<uint8_t> SeenBefore(const PointGrid& grid, const BackgroundState& state);

/// The same more surely: for some frames, at a depth that differs by little more than noise.
std::vector<uint8_t> SeenItself(const PointGrid& grid, const BackgroundState& state);

/// True per cell that stands clearly before a surface that was seen there: it came here.
std::vector<uint8_t> ArrivedSince(const PointGrid& grid, const BackgroundState& state);

/// Surface of those of `cells` that have arrived with all their neighbours.
float ArrivedArea_m2(const PointGrid& grid, const std::vector<int>& cells,
                     const std::vector<uint8_t>& arrived);

/// True per cell where the known background itself is seen.
std::vector<uint8_t> SeenBackground(const PointGrid& grid, const BackgroundState& state,
                                    const BackgroundOptions& options = {});

}  // namespace ossa::depth
