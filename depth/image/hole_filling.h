#pragma once
#include <optional>

#include "depth/image/depth_frame.h"

namespace ossa::depth {

/// Fills scattered single-pixel holes with the median of neighbouring readings; none if they are as
/// rare as with structured-light sensors. Time-of-flight cameras without the driver's filters,
/// active stereo on dark cloth, and depth registered to a larger colour image are full of them, and
/// a tree that probes one takes it for background. Holes wider than two or three pixels, such as a
/// sensor's shadow, are kept.
std::optional<DepthFrame> FillScatteredHoles(const DepthFrame& frame);

}  // namespace ossa::depth
