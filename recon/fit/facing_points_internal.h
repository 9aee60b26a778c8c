#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "recon/fit/posed_surface.h"
#include "recon/fit/seen_person_internal.h"
#include "recon/fit/surface_fit.h"

namespace ossa::recon {

/// The points of a posed surface that face the camera, grouped by part, for nearest-neighbour
/// search.
class FacingPoints {
 public:
  void Gather(const PosedSurface& posed);
  /// The point nearest to a pixel, with a distance penalty for parts other than the pixel's; -1 if
  /// no point faces the camera. Ties within a micrometre are resolved arbitrarily.
  int Nearest(const SeenPerson::Pixel& pixel, const SurfaceFitOptions& options) const;
  /// Their indices among the surface's points.
  const std::vector<uint32_t>& points() const { return points_; }

  using Places = std::array<std::vector<float>, 3>;  // x, y, z

  /// The points of one part. Runs are aligned to lanes; padding points are far away.
  struct Run {
    size_t begin = 0, end = 0;  // indices of the points
    size_t first_place = 0;
    uint8_t part = 0;
  };

  /// Runs with their bounding boxes as lanes; padding boxes are far away.
  struct Runs {
    std::vector<Run> runs;
    std::vector<int32_t> part;
    Places low_m, high_m;

    void Clear();
    void Add(const Run& run, const Places& places_m);
  };

 private:
  std::vector<uint32_t> points_;
  Places places_m_;
  Runs runs_;
};

}  // namespace ossa::recon
