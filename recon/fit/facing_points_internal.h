#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "recon/fit/posed_surface.h"
#include "recon/fit/seen_person_internal.h"
#include "recon/fit/surface_fit.h"

namespace ossa::recon {

/// The points of a posed surface that face the camera, part by part, for the search of the nearest.
class FacingPoints {
 public:
  void Gather(const PosedSurface& posed);
  /// The point nearest to a pixel, where points of parts other than the pixel's count as farther;
  /// -1 where no point faces the camera. Of points equally near to a micrometre it may be any.
  int Nearest(const SeenPerson::Pixel& pixel, const SurfaceFitOptions& options) const;
  /// Their numbers among the surface's points.
  const std::vector<uint32_t>& points() const { return points_; }

  using Places = std::array<std::vector<float>, 3>;  // x, y, z

  /// Points of one part. Their places begin where lanes do, and those that fill the last lanes are
  /// far away.
  struct Run {
    size_t begin = 0, end = 0;  // of the points
    size_t first_place = 0;
    uint8_t part = 0;
  };

  /// With the box around each run, for lanes: those that fill the last lanes are far away.
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
