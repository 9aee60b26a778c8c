#pragma once
#include <optional>
#include <vector>

#include "depth/image/depth_frame.h"
#include "depth/scene/background.h"
#include "depth/scene/floor.h"
#include "depth/scene/point_grid.h"
#include "depth/scene/regions.h"

namespace ossa::depth {

/// All that is remembered of a scene's geometry between frames.
struct SceneState {
  FloorState floor;
  BackgroundState background;
  int frame_width = 0, frame_height = 0;
  std::vector<float> last_z_m;  // of the grid's cells in the last frame, 0 = not measured
  double last_s = -1e9;         // and its time
};

/// Constants: set by hand while developing on rendered rooms with validation subjects (`ossa
/// experiment indoor-scenes`); no sweep is recorded.
struct SceneOptions {
  FloorOptions floor;
  BackgroundOptions background;
  FurnitureOptions furniture;
  /// Measurements farther away are left out, metres, > 0: the Kinect's own range for people ends
  /// before, and beyond a person has too few pixels for the forest.
  float max_depth_m = 6.0F;
  /// Without frames for so long, seconds, the scene is fresh: anything may have been moved.
  double fresh_s = 0.3;
  /// A time that runs back by no more, seconds, is the logger's doing and no other recording: that
  /// of recon::FrameSteps::kJitter_s.
  double jitter_s = 0.005;
  /// Another scene is seen when more than half of the cells measured in both frames, which must be
  /// more than `changed_cells`, lie elsewhere by so many metres beyond three times the depth
  /// tolerance. Nothing that moves in a room covers so much of it between two frames.
  float changed_m = 0.15F;
  int changed_cells = 500;
};

/// The geometry of one frame: surfaces, not yet objects.
struct Scene {
  PointGrid grid;
  std::optional<FloorPlane> floor;
  RoomShape surfaces;          // floor, walls, furniture
  BackgroundMasks background;  // compared with the frames before
  bool fresh = true;           // no frame of this scene was seen a moment ago
  bool changed = true;         // the frame before showed another scene, or there was none
};

/// Floor, planes, furniture and background of a frame. Whoever knows what in the scene is no
/// background tells it afterwards: LearnBackground.
Scene MeasureScene(const DepthFrame& frame, SceneState& state, const SceneOptions& options = {});

}  // namespace ossa::depth
