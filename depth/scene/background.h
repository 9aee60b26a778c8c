#pragma once
#include <cstdint>
#include <vector>

#include "depth/scene/point_grid.h"

namespace ossa::depth {

/// The background model: the farthest steady surface seen in each cell. No empty room is needed:
/// somebody who moves uncovers what is behind, and whatever nobody claims for `steady_frames`
/// becomes background.
struct BackgroundState {
  int width = 0, height = 0;     // of the grid that it was learned from, cells
  std::vector<float> surface_m;  // a cell: z of the surface, metres, 0 = none known
  std::vector<uint8_t> steady;   // a cell: frames it was seen there, saturating
};

/// Constants: set by hand while developing on rendered rooms with validation subjects (`ossa
/// experiment indoor-scenes`); no sweep is recorded.
struct BackgroundOptions {
  /// Frames until a surface counts as background, in [1, 250]; two thirds of a second at 30 Hz.
  int steady_frames = 20;
  /// Share of known cells, in (0, 1], that are suddenly farther away when the sensor was moved.
  double moved_share = 0.5;
  /// Frames until a surface counts as the same one for certain, in [1, 250].
  int certain_frames = 3;
  /// ... within so much of the depth tolerance: one and a half steps of a structured-light sensor.
  float certain_tolerance = 0.5F;
  /// Foreground is nearer than the surface behind it by so much beyond the depth tolerance, metres.
  float foreground_m = 0.1F;
};

/// A frame compared with the background model. One entry a cell, 1 = yes; all 0 where nothing is
/// known of a grid of this size.
struct BackgroundMasks {
  std::vector<uint8_t> steady;      // the background that was seen for `steady_frames`
  std::vector<uint8_t> known;       // the surface that was seen in the frame before, nobody's
  std::vector<uint8_t> certain;     // the same for `certain_frames`, by little more than noise
  std::vector<uint8_t> foreground;  // stands clearly before a surface seen there: it came here
};
BackgroundMasks CompareWithBackground(const PointGrid& grid, const BackgroundState& state,
                                      const BackgroundOptions& options = {});

/// Surface of those of `cells` that are foreground with all their neighbours, square metres: the
/// rims of furniture flicker.
float MeasureForegroundArea_m2(const PointGrid& grid, const std::vector<int>& cells,
                               const std::vector<uint8_t>& foreground);

/// Learns from one frame. `claimed` (one entry a cell) marks the cells of people: never learned.
void LearnBackground(const PointGrid& grid, const std::vector<uint8_t>& claimed,
                     BackgroundState& state, const BackgroundOptions& options = {});

}  // namespace ossa::depth
