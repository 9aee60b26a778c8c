#pragma once
#include <optional>

#include "depth/image/depth_frame.h"
#include "recon/fit/surface_fit.h"
#include "tools/people/detection.h"
#include "tools/tracker/person_internal.h"

namespace ossa::tracker {

/// Fits the body surface to the person's pixels, starting from the refined joints in `body`, else
/// from the raw ones, and updates the person's shape. Nothing if too little is visible.
std::optional<recon::SurfaceFit> FitSurface(const depth::DepthFrame& frame,
                                            const people::Detection& detection, const Body& body,
                                            Person& person);

/// Lowers the trust (confidence or reliability, [0, 1]) in joints whose segments are far from the
/// pixels they should explain, see SurfaceFitOptions::doubt_residual_m. Segments without pixels are
/// left alone.
void DoubtUnexplained(const recon::SurfaceFit& fit, const recon::BodySurface& surface,
                      double doubt_residual_m, recon::JointArray<double>& trust);

}  // namespace ossa::tracker
