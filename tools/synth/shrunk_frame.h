#pragma once
#include "tools/synth/dataset.h"

namespace ossa::tools {

/// The frame shrunk by nearest neighbour, as who keeps depth images small does: pixel u of the
/// shrunk image is pixel floor((u + 1/2) shrink) of the large one. `frame` is the crop that begins
/// at (u0, v0) of the large image; `whole` the camera of the whole shrunk one. Joints and floor
/// stay.
LabelledFrame ShrunkFrame(const LabelledFrame& frame, int u0, int v0, double shrink,
                          const depth::Camera& whole);

}  // namespace ossa::tools
