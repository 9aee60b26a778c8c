#pragma once
#include <cstdint>
#include <span>

#include "depth/render/renderer.h"
#include "recon/body/body_model.h"

namespace ossa::tools {

/// Infrared reflectance of each pixel of a rendered image, in [0, 1], height x width: low for hair,
/// high for skin, anything for cloth and objects. `meshes[i]` is person i's mesh. Equal seeds give
/// equal materials.
depth::Image<float> DrawReflectance(const depth::RenderedImage& seen, const recon::BodyModel& model,
                                    std::span<const int> meshes, uint64_t seed);

}  // namespace ossa::tools
