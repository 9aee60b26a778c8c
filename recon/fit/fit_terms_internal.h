#pragma once
#include <cstddef>

#include "recon/fit/facing_points_internal.h"
#include "recon/fit/normal_equations.h"
#include "recon/fit/seen_person_internal.h"

namespace ossa::recon {

/// The mean of the pixels' weighted squares along the normal: 1 where they are as far off as was
/// expected of them; 0 without pixels.
double AddPixels(const PosedSurface& posed, const FacingPoints& facing, const SeenPerson& seen,
                 const SurfaceFitOptions& options, NormalEquations& equations);
void AddSilhouette(const PosedSurface& posed, const SeenPerson& seen,
                   const SurfaceFitOptions& options, NormalEquations& equations);
/// How many times as far off as a sure one a joint that the fit starts from is expected to be, by
/// its confidence (none counts as 0): 1 or more.
double ComputeDoubt(const SurfaceFitInput& input, const SurfaceFitOptions& options, size_t joint);
/// How far off a joint that the fit starts from is expected to be, along each axis: by its
/// confidence (none counts as 0) and by the size of a pixel there.
double ComputeJointVariance_m2(const SurfaceFitInput& input, const SurfaceFitOptions& options,
                               size_t joint);
void AddJoints(const PosedSurface& posed, const SurfaceFitInput& input,
               const SurfaceFitOptions& options, NormalEquations& equations);
/// How much the shape that is known counts, against a component's variance.
double ComputeShapeWeight(const SurfaceFitInput& input, const SurfaceFitOptions& options);
/// After NormalEquations::Assemble.
void AddPriors(const PosedSurface& posed, const SurfaceFitInput& input,
               const SurfaceFitOptions& options, NormalEquations& equations);

}  // namespace ossa::recon
