#pragma once
#include <limits>
#include <optional>
#include <vector>

#include "depth/image/depth_frame.h"
#include "depth/scene/background.h"
#include "depth/scene/floor.h"
#include "depth/scene/point_grid.h"
#include "depth/scene/regions.h"

namespace ossa::depth {

/// State of a scene's geometry between frames.
struct SceneState {
  FloorState floor;
  BackgroundState background;
  int frame_width = 0, frame_height = 0;
  std::vector<float> last_z_m;  // depth of each cell in the last frame, 0 = not measured
  double last_s = -std::numeric_limits<double>::infinity();  // time of the last frame
};

/// Constants: set by hand while developing on rendered rooms with validation subjects (`ossa
/// experiment indoor-scenes`); no sweep is recorded.
struct SceneOptions {
  FloorOptions floor;
  BackgroundOptions background;
  FurnitureOptions furniture;
  /// Farther measurements are ignored, metres, > 0: the Kinect's range for people ends earlier, and
  /// farther people have too few pixels for the forest.
  float max_depth_m = 6.0F;
  /// After this time without frames, seconds, the scene is fresh: anything may have moved.
  double fresh_s = 0.3;
  /// Times that run back by less, seconds, are logger jitter and not a new recording: that of
  /// recon::FrameSteps::kJitter_s.
  double jitter_s = 0.005;
  /// The scene has changed if more than half of the cells measured in both frames, which must be
  /// more than `changed_cells`, differ by this many metres beyond three times the depth tolerance.
  /// Nothing that moves in a room covers so much of it between two frames.
  float changed_m = 0.15F;
  int changed_cells = 500;
};

/// The geometry of one frame: surfaces, without objects.
struct Scene {
  PointGrid grid;
  std::optional<FloorPlane> floor;
  RoomShape surfaces;          // floor, walls, furniture
  BackgroundMasks background;  // from the comparison with earlier frames
  bool fresh = true;           // there was no recent frame of this scene
  bool changed = true;         // the previous frame showed another scene, or there was none
};

/// Measures floor, planes, furniture and background of a frame. Call LearnBackground afterwards,
/// when it is known which cells are not background.
Scene MeasureScene(const DepthFrame& frame, SceneState& state, const SceneOptions& options = {});

}  // namespace ossa::depth
