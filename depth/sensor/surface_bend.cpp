#include "depth/sensor/surface_bend.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "depth/sensor/corner_internal.h"
#include "depth/sensor/parabola_internal.h"

// Constants: chosen on 1 100 rendered frames of every view, noise and size and on the real ones of
// depth_units_test.cpp: none is suspected, and two thirds to four fifths of the rendered ones are
// when inverted. The rest shows too few slanted surfaces.
namespace ossa::depth {
namespace {

// Curvature relative to that of a plane with this slope: 1 for a plane. None if the surface is
// hardly slanted, falls away like an edge, or is not smooth.
std::optional<double> ComputePlaneBend(const Parabola::Fit& fit) {
  constexpr double kLeastSlope = 0.05, kMostSlope = 0.6;     // of the distance, over half a window
  constexpr double kMostRest = 0.7, kMostError = 1.0 / 3.0;  // of a plane's curvature
  const double slope = std::abs(fit.slope), plane = slope * slope / fit.middle;
  if (slope < kLeastSlope * fit.middle || slope > kMostSlope * fit.middle) return std::nullopt;
  if (fit.rest > kMostRest * plane || fit.bend_error > kMostError * plane) return std::nullopt;
  return fit.bend / plane;
}

bool IsMostly(int64_t some, int64_t others) {
  constexpr int64_t kMostly = 3;  // majority ratio
  return some > kMostly * others;
}

}  // namespace

void SurfaceBend::AddLines(const DepthView& image, bool columns) {
  constexpr int kWindows = 10;   // windows per row
  constexpr int kLeastSize = 8;  // pixels
  constexpr int kLines = 160;    // evaluated lines per image width
  constexpr double kKink = 0.8;  // ratio of residuals; by hand: with noise both are equal
  constexpr int kMargins = 12;   // smoothing bends surfaces beside holes: this part of a window
  const int size = std::max(kLeastSize, image.width / kWindows);
  const int step = std::max(1, image.width / kLines), hop = size / 4;
  const int lines = columns ? image.width : image.height;
  const int length = columns ? image.height : image.width;
  const auto depth_at = [&](int line, int i) -> int {  // the border continues
    const int at = std::clamp(i, 0, length - 1);
    return columns ? image.at(line, at) : image.at(at, line);
  };
  const Parabola parabola(size);
  const Corner corner(size);
  const int around = size / kMargins;
  std::vector<double> z(static_cast<size_t>(size));
  for (int line = 0; line < lines; line += step) {
    for (int begin = 0; begin + size <= length; begin += hop) {
      ++windows_;
      for (int i = 0; i < size; ++i) z[static_cast<size_t>(i)] = depth_at(line, begin + i);
      if (std::find(z.begin(), z.end(), 0.0) != z.end()) continue;
      if (depth_at(line, begin - around) == 0 || depth_at(line, begin + size - 1 + around) == 0)
        continue;
      const Parabola::Fit fit = parabola.Through(z);
      const auto bend = ComputePlaneBend(fit);
      if (bend && *bend > 0.4 && *bend < 1.8) ++as_planes_;
      const bool is_opposite = bend && *bend > -8.0 && *bend < -0.1;
      // The corner between floor and wall bends in the same direction, but as a kink.
      if (is_opposite && corner.Rest(z) > kKink * fit.rest) ++opposite_;
    }
  }
}

void SurfaceBend::Add(const DepthView& image) {
  AddLines(image, false);
  AddLines(image, true);
}

bool SurfaceBend::IsInverted() const {
  constexpr double kEnough = 0.012;  // share of the windows: a corner of a room has fewer
  return static_cast<double>(as_planes_ + opposite_) > kEnough * static_cast<double>(windows_) &&
         IsMostly(opposite_, as_planes_);
}

bool SurfaceBend::IsNotInverted() const {
  constexpr int64_t kFew = 12;  // windows; narrow views show few slanted surfaces
  return as_planes_ >= kFew && IsMostly(as_planes_, opposite_);
}

}  // namespace ossa::depth
