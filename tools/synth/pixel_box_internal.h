#pragma once
#include <Eigen/Core>
#include <limits>
#include <vector>

#include "depth/image/camera.h"

namespace ossa::tools {

/// A rectangle of pixels, bounds inclusive; empty by default.
struct PixelBox {
  int u0 = std::numeric_limits<int>::max(), v0 = u0, u1 = -1, v1 = -1;
};

/// Pixels that a mesh (vertices in camera space, metres) may cover, and a border around them.
PixelBox BoundingBoxOf(const std::vector<Eigen::Vector3f>& vertices_m, const depth::Camera& camera);

/// The smallest box around both.
PixelBox Union(const PixelBox& a, const PixelBox& b);

}  // namespace ossa::tools
