#pragma once
#include <optional>

#include "depth/image/depth_frame.h"
#include "recon/fit/surface_fit.h"
#include "tools/people/detection.h"
#include "tools/tracker/person_internal.h"

namespace ossa::tracker {

/// The body whose surface explains the person's pixels, from the refined joints in `body` on, else
/// from the raw ones; the person's shape gets its vote. None where the image shows too little.
std::optional<recon::SurfaceFit> FitSurface(const depth::DepthFrame& frame,
                                            const people::Detection& detection, const Body& body,
                                            Person& person);

/// Trusts joints less whose segments are far from the pixels that they should explain (confidence
/// or reliability, [0, 1]), see SurfaceFitOptions::doubt_residual_m. Of segments without pixels
/// nothing is said.
void DoubtUnexplained(const recon::SurfaceFit& fit, const recon::BodySurface& surface,
                      double doubt_residual_m, recon::JointArray<double>& trust);

}  // namespace ossa::tracker
