#pragma once
#include <cstdint>
#include <vector>

#include "depth/scene/point_grid.h"

namespace ossa::depth {

/// The background model: the farthest steady surface of each cell. It needs no empty room: a moving
/// person uncovers what is behind, and any surface unclaimed for `steady_frames` becomes
/// background.
struct BackgroundState {
  int width = 0, height = 0;     // size of its grid, cells
  std::vector<float> surface_m;  // per cell: z of the surface, metres, 0 = unknown
  std::vector<uint8_t> steady;   // per cell: frames in which it was seen, saturating
  std::vector<uint8_t> empty;    // per cell: frames without a reading before the first one,
                                 // saturating: nothing is there within the sensor's range
  std::vector<uint8_t> claimed;  // per cell: 1 if a person's in the last frame
};

/// Constants: set by hand while developing on rendered rooms with validation subjects (`ossa
/// experiment indoor-scenes`); no sweep is recorded.
struct BackgroundOptions {
  /// Frames after which a surface is background, in [1, 250]; two thirds of a second at 30 Hz.
  int steady_frames = 20;
  /// Share of known cells, in (0, 1], that are suddenly farther away if the sensor was moved.
  /// Turned sideways by 5 degrees in six rendered rooms: 6.7 to 32 %. Not moved: at most 0.2 %
  /// there, 3 % in a real recording at 10 Hz.
  double moved_share = 0.05;
  /// Share of the image's blocks, in (0, 1], where surfaces of nobody are a little nearer than
  /// before if the sensor is being carried. With a fixed sensor as many people are found in
  /// rooms of one to six as without this test (docs/benchmarks/tracking.md).
  double nearer_blocks = 0.2;
  /// Frames after which a surface is certainly unchanged, in [1, 250].
  int certain_frames = 3;
  /// ... within this share of the depth tolerance: one and a half steps of a structured-light
  /// sensor.
  float certain_tolerance = 0.5F;
  /// Frames without any reading, in [1, 250], after which a surface in a cell is foreground: glass,
  /// dark cloth and noise have some sooner.
  int empty_frames = 20;
  /// Foreground is nearer than the surface behind it by this distance beyond the depth tolerance,
  /// metres.
  float foreground_m = 0.1F;
};

/// Clears the model if the sensor was moved since the frame before: many known surfaces are
/// suddenly farther away, or surfaces of nobody are nearer all over the image. To be called before
/// the comparison, in which furniture seen from another place would be foreground.
void ForgetIfSensorMoved(const PointGrid& grid, BackgroundState& state,
                         const BackgroundOptions& options = {});

/// A frame compared with the background model. One entry per cell, 1 = yes; all 0 without a model
/// of this grid size.
struct BackgroundMasks {
  std::vector<uint8_t> steady;      // background seen for `steady_frames`
  std::vector<uint8_t> known;       // the unclaimed surface of the frame before
  std::vector<uint8_t> certain;     // the same for `certain_frames`, within little more than noise
  std::vector<uint8_t> foreground;  // clearly in front of a known surface, or where nothing was: it
                                    // has moved here
  double certain_share = 0;         // of the measured cells, [0, 1]
};
BackgroundMasks CompareWithBackground(const PointGrid& grid, const BackgroundState& state,
                                      const BackgroundOptions& options = {});

/// Area of those of `cells` that are foreground with all their neighbours, square metres: the edges
/// of furniture flicker.
float MeasureForegroundArea_m2(const PointGrid& grid, const std::vector<int>& cells,
                               const std::vector<uint8_t>& foreground);

/// Removes a person's surface from the model, where it was learned in the few frames before they
/// were recognised: what was seen for `steady_frames` stays. `cells`: the person's, of the grid.
void ForgetBackground(const PointGrid& grid, const std::vector<int>& cells, BackgroundState& state,
                      const BackgroundOptions& options = {});

/// Updates the model with a frame. `claimed` (one entry per cell) marks the cells of people, which
/// are never learned.
void LearnBackground(const PointGrid& grid, const std::vector<uint8_t>& claimed,
                     BackgroundState& state, const BackgroundOptions& options = {});

}  // namespace ossa::depth
