#include <algorithm>

#include "tools/synth/pixel_box_internal.h"

namespace ossa::tools {
namespace {

constexpr int kBorder_px = 12;  // rendered around the people, for edges and shadows; by hand

}  // namespace

PixelBox BoundingBoxOf(const std::vector<Eigen::Vector3f>& vertices_m,
                       const depth::Camera& camera) {
  constexpr float kTooNear_m = 0.1f;  // by hand: nearer points project far outside
  PixelBox box;
  float u0 = 1e9f, u1 = -1e9f, v0 = 1e9f, v1 = -1e9f;
  for (const auto& p : vertices_m) {
    if (p.z() < kTooNear_m) return {0, 0, camera.width - 1, camera.height - 1};
    const float u = static_cast<float>(camera.cx) - static_cast<float>(camera.fx) * p.x() / p.z();
    const float v = static_cast<float>(camera.cy) - static_cast<float>(camera.fy) * p.y() / p.z();
    u0 = std::min(u0, u), u1 = std::max(u1, u);
    v0 = std::min(v0, v), v1 = std::max(v1, v);
  }
  const auto pixel = [](float at, int limit) {
    return static_cast<int>(std::clamp(at, -1.0f, static_cast<float>(limit)));
  };
  box.u0 = std::max(0, pixel(u0, camera.width) - kBorder_px);
  box.v0 = std::max(0, pixel(v0, camera.height) - kBorder_px);
  box.u1 = std::min(camera.width - 1, pixel(u1, camera.width) + kBorder_px);
  box.v1 = std::min(camera.height - 1, pixel(v1, camera.height) + kBorder_px);
  return box;
}

PixelBox Union(const PixelBox& a, const PixelBox& b) {
  return {std::min(a.u0, b.u0), std::min(a.v0, b.v0), std::max(a.u1, b.u1), std::max(a.v1, b.v1)};
}

}  // namespace ossa::tools
