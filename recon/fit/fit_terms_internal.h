#pragma once
#include <cstddef>

#include "recon/fit/facing_points_internal.h"
#include "recon/fit/normal_equations.h"
#include "recon/fit/seen_person_internal.h"

namespace ossa::recon {

/// Adds the pixel terms. Returns the mean of their weighted squared residuals along the normal: 1
/// if these are as large as expected; 0 without pixels.
double AddPixels(const PosedSurface& posed, const FacingPoints& facing, const SeenPerson& seen,
                 const SurfaceFitOptions& options, NormalEquations& equations);
void AddSilhouette(const PosedSurface& posed, const SeenPerson& seen,
                   const SurfaceFitOptions& options, NormalEquations& equations);
/// The factor >= 1 by which a start joint's expected error exceeds that of a joint of confidence 1
/// (no confidence counts as 0).
double ComputeDoubt(const SurfaceFitInput& input, const SurfaceFitOptions& options, size_t joint);
/// Expected variance of a start joint along each axis, from its confidence (none counts as 0) and
/// the size of a pixel at its depth.
double ComputeJointVariance_m2(const SurfaceFitInput& input, const SurfaceFitOptions& options,
                               size_t joint);
void AddJoints(const PosedSurface& posed, const SurfaceFitInput& input,
               const SurfaceFitOptions& options, NormalEquations& equations);
/// Weight of the known shape relative to the variance of a shape component.
double ComputeShapeWeight(const SurfaceFitInput& input, const SurfaceFitOptions& options);
/// Adds the priors; call it after NormalEquations::Assemble.
void AddPriors(const PosedSurface& posed, const SurfaceFitInput& input,
               const SurfaceFitOptions& options, NormalEquations& equations);

}  // namespace ossa::recon
