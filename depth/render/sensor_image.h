#pragma once
#include <cstdint>

#include "depth/image/image.h"
#include "depth/render/renderer.h"

namespace ossa::depth {

/// What a simulated sensor delivers of a rendered image; both images have the camera's size.
struct SensorImage {
  Image<uint16_t> depth_mm;  // 0 = no reading
  /// v * width + u of the rendered pixel whose surface was measured, so that labels can follow it;
  /// -1 where there is no reading.
  Image<int32_t> source;
};

/// The rendered image in whole millimetres, nothing lost.
SensorImage PerfectSensor(const RenderedImage& rendered);

}  // namespace ossa::depth
