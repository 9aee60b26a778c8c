#pragma once
#include "tools/synth/dataset.h"

namespace ossa::tools {

/// Shrinks a frame by nearest neighbour, as recorders do that keep depth images small: pixel u of
/// the shrunk image is pixel floor((u + 1/2) shrink) of the large one. `frame` is a crop of the
/// large image that begins at (u0, v0); `whole` is the camera of the whole shrunk image. Joints and
/// floor stay the same.
LabelledFrame ShrunkFrame(const LabelledFrame& frame, int u0, int v0, double shrink,
                          const depth::Camera& whole);

}  // namespace ossa::tools
