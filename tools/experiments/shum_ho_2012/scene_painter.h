#pragma once
#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "physics/world.h"
#include "recon/posture.h"
#include "tools/experiments/animated_png.h"

namespace ossa::tools {

/// The view of a scene. World: metres, y up, floor at y = 0.
struct SceneView {
  Eigen::Vector3d eye_m = {2.5, 1.8, 3.5};
  Eigen::Vector3d look_at_m = {0.0, 0.9, 0.5};
  double focal_px = 300.0;
  int width = 320;
  int height = 240;
};

/// Drawn over the world: the target skeletons of the characters (the paper's yellow lines) and a
/// caption.
struct SceneOverlay {
  std::vector<recon::Posture> targets;
  std::string caption;
};

/// A picture of a world by the painter's algorithm: characters as rounded limbs, objects, their
/// shadows and a floor grid. For inspection only.
Picture Paint(const physics::World& world, const SceneView& view, const SceneOverlay& overlay);

}  // namespace ossa::tools
