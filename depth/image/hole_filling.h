#pragma once
#include <optional>

#include "depth/image/depth_frame.h"

namespace ossa::depth {

/// The frame with its scattered single-pixel holes filled, each by the median of the readings next
/// to it; nothing where they are as few as a structured-light sensor's. Time-of-flight cameras
/// without the driver's filters, active stereo before dark cloth and depth registered to a larger
/// colour image are full of them, and a tree that looks at one takes it for background. Holes wider
/// than two or three pixels, such as a sensor's shadow, stay holes.
std::optional<DepthFrame> FillScatteredHoles(const DepthFrame& frame);

}  // namespace ossa::depth
