#include "depth/sensor/readers/lens_camera.h"

#include <cmath>

namespace ossa::depth {
namespace {

// Radial distortion factor at distance r from the axis; r2 is r squared.
double ComputeRadialFactor(const LensCamera& lens, double r2) {
  return (1 + r2 * (lens.k1 + r2 * (lens.k2 + r2 * lens.k3))) /
         (1 + r2 * (lens.k4 + r2 * (lens.k5 + r2 * lens.k6)));
}

}  // namespace

double ComputeFoldingRadius(const LensCamera& lens) {
  constexpr double kStep = 0.01, kMost = 4.0;  // x/z, a ratio; 76 degrees off the axis; by hand
  double seen = 0.0, radius = 0.0;
  while (radius < kMost) {
    const double next = radius + kStep;
    const double next_seen = next * ComputeRadialFactor(lens, next * next);
    if (!(next_seen > seen)) break;
    radius = next;
    seen = next_seen;
  }
  return radius;
}

std::vector<int32_t> UndistortionMap(const LensCamera& lens) {
  const Camera& c = lens.pinhole;
  std::vector<int32_t> map;
  for (int v = 0; v < c.height; ++v) {
    for (int u = 0; u < c.width; ++u) {
      const double x = (u - c.cx) / c.fx, y = (v - c.cy) / c.fy;
      const double r2 = x * x + y * y;
      const double radial = ComputeRadialFactor(lens, r2);
      const double xd = x * radial + (r2 + 2 * x * x) * lens.p2 + 2 * x * y * lens.p1;
      const double yd = y * radial + (r2 + 2 * y * y) * lens.p1 + 2 * x * y * lens.p2;
      const double from_u = std::round(c.cx + c.fx * xd), from_v = std::round(c.cy + c.fy * yd);
      const bool inside = from_u >= 0 && from_v >= 0 && from_u < c.width && from_v < c.height &&
                          r2 <= lens.largest_radius * lens.largest_radius;
      map.push_back(inside ? static_cast<int32_t>(from_v) * c.width + static_cast<int32_t>(from_u)
                           : -1);
    }
  }
  return map;
}

std::vector<uint16_t> Undistorted(std::span<const uint16_t> depth,
                                  const std::vector<int32_t>& map) {
  std::vector<uint16_t> image(map.size(), 0);
  for (size_t i = 0; i < map.size(); ++i) {
    if (map[i] >= 0) image[i] = depth[static_cast<size_t>(map[i])];
  }
  return image;
}

}  // namespace ossa::depth
