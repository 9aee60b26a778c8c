#include "depth/scene/measure_scene.h"

#include <cmath>

namespace ossa::depth {
namespace {

bool ShowsAnotherScene(const PointGrid& grid, const SceneState& state,
                       const SceneOptions& options) {
  if (state.last_z_m.size() != static_cast<size_t>(grid.cells())) return false;
  int both = 0, elsewhere = 0;
  for (int i = 0; i < grid.cells(); ++i) {
    const float before = state.last_z_m[static_cast<size_t>(i)];
    if (!grid.valid(i) || before <= 0) continue;
    ++both;
    const float tolerance_m = options.changed_m + 3 * DepthTolerance(before);
    elsewhere += std::abs(grid.z(i) - before) > tolerance_m ? 1 : 0;
  }
  return both > options.changed_cells && 2 * elsewhere > both;
}

// Resets the state for a frame of another size or scene. Returns whether it did.
bool ForgetAnotherScene(const DepthFrame& frame, const PointGrid& grid, SceneState& state,
                        const SceneOptions& options) {
  const bool same_size =
      state.frame_width == frame.camera.width && state.frame_height == frame.camera.height;
  const bool changed = !same_size || ShowsAnotherScene(grid, state, options);
  if (changed) {
    state = {};
    state.frame_width = frame.camera.width;
    state.frame_height = frame.camera.height;
  }
  state.last_z_m.resize(static_cast<size_t>(grid.cells()));
  for (int i = 0; i < grid.cells(); ++i) state.last_z_m[static_cast<size_t>(i)] = grid.z(i);
  return changed;
}

}  // namespace

Scene MeasureScene(const DepthFrame& frame, SceneState& state, const SceneOptions& options) {
  Scene scene;
  scene.grid = MakePointGrid(frame.view(), frame.camera, options.max_depth_m);
  scene.changed = ForgetAnotherScene(frame, scene.grid, state, options);
  const double since_s = frame.time_s - state.last_s;
  scene.fresh = since_s < -options.jitter_s || since_s > options.fresh_s;
  state.last_s = frame.time_s;
  scene.floor = FindFloor(scene.grid, state.floor, options.floor);
  if (scene.floor) scene.grid.up = scene.floor->coefficients.head<3>().cast<float>();
  scene.surfaces = FindRoomSurfaces(scene.grid, scene.floor, options.furniture);
  ForgetIfSensorMoved(scene.grid, state.background, options.background);
  scene.background = CompareWithBackground(scene.grid, state.background, options.background);
  return scene;
}

}  // namespace ossa::depth
