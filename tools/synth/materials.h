#pragma once
#include <cstdint>
#include <span>

#include "depth/render/renderer.h"
#include "recon/body/body_model.h"

namespace ossa::tools {

/// How much infrared light the surfaces of a rendered image send back, [0, 1]: hair little, skin
/// much, cloth and things anything, some of it next to nothing. `meshes[i]` is person i's. The same
/// seed gives the same people the same clothes.
depth::Image<float> DrawReflectance(const depth::RenderedImage& seen, const recon::BodyModel& model,
                                    std::span<const int> meshes, uint64_t seed);

}  // namespace ossa::tools
