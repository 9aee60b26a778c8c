#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "depth/image/depth_frame.h"

namespace ossa::people {

/// A candidate at a fraction of the frame's resolution.
struct Subsampled {
  depth::DepthFrame frame;
  std::vector<int32_t> pixels;  // of `frame`, ascending
};

/// Takes every scale-th pixel in both directions. Features are measured in pixel·metres, so that a
/// smaller image with a smaller focal length shows the same body.
Subsampled Subsample(const depth::DepthFrame& frame, std::span<const int32_t> pixels, int scale);

}  // namespace ossa::people
