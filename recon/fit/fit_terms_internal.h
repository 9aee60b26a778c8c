#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "recon/fit/normal_equations.h"
#include "recon/fit/seen_person_internal.h"

namespace ossa::recon {

/// The points of a posed surface that face the camera, part by part, for the search of the nearest.
class FacingPoints {
 public:
  void Gather(const PosedSurface& posed);
  /// The point nearest to a pixel, where points of parts other than the pixel's count as farther;
  /// -1 where no point faces the camera.
  int Nearest(const SeenPerson::Pixel& pixel, const SurfaceFitOptions& options) const;
  const std::vector<uint32_t>& points() const { return points_; }

 private:
  struct Run {  // points of one part
    size_t begin = 0, end = 0;
    uint8_t part = 0;
    Eigen::Vector3d middle_m;
    double radius_m = 0.0;
  };
  std::vector<uint32_t> points_;          // numbers of the surface's points
  std::vector<Eigen::Vector3d> place_m_;  // of each of them
  std::vector<Run> runs_;
};

/// Whether two parts, 1..31, are one or touch.
bool AreAdjacentParts(uint8_t a, uint8_t b);

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
