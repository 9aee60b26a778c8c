#pragma once
#include <cstdint>
#include <functional>
#include <vector>

#include "recon/body/body_model.h"
#include "recon/body/rig.h"
#include "recon/fit/body_mesh.h"

namespace ossa::tools {

/// Options of learning a body surface.
struct BodySurfaceOptions {
  size_t points = 600;      // by hand: 4 to 5 cm apart
  size_t people = 500;      // dressed bodies that shape is learned from; chosen by hand
  uint64_t seed = 1;        // of their shapes and clothes; by convention
  size_t triangles = 4000;  // of the mesh, about; by hand: hands still have fingers
  std::function<void(size_t)> progress;  // called with the number of dressed people; may be empty,
                                         // or throw to end it
  size_t frame_step = 10;  // of motion every so many frames; by hand: neighbours are alike
};

/// The body that the surface fit poses. Its surface: points spread evenly over the skin, which
/// shapes and clothes move by the first principal components of dressed people (train shapes), and
/// how people turn their joints in motion. Its mesh: the skin in few triangles, moved by the same
/// components; none where `with_mesh` is false. Throws std::invalid_argument for options out of
/// range and where the motion has no frames, and as SimplifySkin does.
recon::BodyMesh LearnBody(const recon::BodyModel& model,
                          const std::vector<recon::MotionClip>& motion, bool with_mesh,
                          const BodySurfaceOptions& options = {});

}  // namespace ossa::tools
