#pragma once
// Images of plain walls as the renderer would make them, and statistics of what a sensor reads.
#include <algorithm>
#include <cmath>

#include "depth/render/renderer.h"
#include "depth/render/sensor_image.h"

namespace ossa::depth {

inline RenderedImage WallAt(const Camera& camera, float z_m) {
  const int w = camera.width, h = camera.height;
  return {{w, h, z_m}, {w, h, 0}, {w, h, 0}, {w, h, 1.0F}, {w, h, 1}};
}

/// The image's right half is near, its left half far.
inline RenderedImage StepAt(const Camera& camera, float near_m, float far_m) {
  RenderedImage step = WallAt(camera, far_m);
  for (int v = 0; v < camera.height; ++v) {
    for (int u = camera.width / 2; u < camera.width; ++u) step.depth_m.at(u, v) = near_m;
  }
  return step;
}

struct Spread {
  double mean_mm = 0, deviation_mm = 0;
};

inline Spread SpreadIn(const SensorImage& image, int u0, int v0, int width, int height) {
  double sum = 0, squares = 0, count = 0;
  for (int v = v0; v < v0 + height; ++v) {
    for (int u = u0; u < u0 + width; ++u) {
      const double mm = image.depth_mm.at(u, v);
      if (mm > 0) sum += mm, squares += mm * mm, ++count;
    }
  }
  const double mean_mm = sum / count;
  return {mean_mm, std::sqrt(std::max(0.0, squares / count - mean_mm * mean_mm))};
}

inline Spread SpreadOf(const SensorImage& image, int width, int height) {
  return SpreadIn(image, 0, 0, width, height);
}

inline double ReadShare(const SensorImage& image) {
  const auto& mm = image.depth_mm.data;
  const auto missing = std::count(mm.begin(), mm.end(), 0);
  return 1.0 - static_cast<double>(missing) / static_cast<double>(mm.size());
}

}  // namespace ossa::depth
