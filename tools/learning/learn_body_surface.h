#pragma once
#include <cstdint>
#include <functional>
#include <vector>

#include "recon/body/body_model.h"
#include "recon/body/rig.h"
#include "recon/fit/body_surface.h"

namespace ossa::tools {

/// How a body surface is learned.
struct BodySurfaceOptions {
  size_t points = 600;     // by hand: 4 to 5 cm apart
  size_t people = 500;     // dressed bodies that shape is learned from; chosen by hand
  uint64_t seed = 1;       // of their shapes and clothes; by convention
  size_t frame_step = 10;  // of motion every so many frames; by hand: neighbours are alike
};

/// The surface that the surface fit poses: points spread evenly over the skin, which shapes and
/// clothes move by the first principal components of dressed people (train shapes), and how people
/// turn their joints in motion. Throws std::invalid_argument for options out of range and where the
/// motion has no frames.
recon::BodySurface LearnBodySurface(const recon::BodyModel& model,
                                    const std::vector<recon::MotionClip>& motion,
                                    const BodySurfaceOptions& options = {});

}  // namespace ossa::tools
