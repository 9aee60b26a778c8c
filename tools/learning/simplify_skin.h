#pragma once
#include <cstddef>
#include <vector>

#include "recon/body/body_model.h"
#include "recon/fit/body_mesh.h"

namespace ossa::tools {

/// Some of a body model's vertices, and triangles between them (numbers in `vertices`).
struct SimplifiedSkin {
  std::vector<size_t> vertices;
  std::vector<recon::MeshTriangle> triangles;
};

/// The model's skin in about so many triangles, whose corners are vertices of the model. Throws
/// InputError where ossa was built without meshoptimizer.
SimplifiedSkin SimplifySkin(const recon::BodyModel& model, size_t triangles);

}  // namespace ossa::tools
