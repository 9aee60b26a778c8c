#pragma once
#include <cstdint>

#include "depth/image/image.h"
#include "depth/render/renderer.h"

namespace ossa::depth {

/// The output of a simulated sensor; both images have the camera's size.
struct SensorImage {
  Image<uint16_t> depth_mm;  // 0 = no reading
  /// v * width + u of the rendered pixel whose surface was measured, for transferring labels; -1
  /// without a reading.
  Image<int32_t> source;
};

/// The rendered image, rounded to millimetres, without errors.
SensorImage PerfectSensor(const RenderedImage& rendered);

}  // namespace ossa::depth
