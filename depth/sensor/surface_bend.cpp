#include "depth/sensor/surface_bend.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

// Constants: chosen on 1 100 rendered frames of every view, noise and size and on the real ones
// that depth_units_test.cpp looks at: none is suspected, and of the rendered ones turned round two
// thirds to four fifths are. The rest shows too few slanted surfaces.
namespace ossa::depth {
namespace {

// A parabola a + b t + c t^2 through numbers at equal steps of t from -1 to 1.
class Parabola {
 public:
  struct Fit {
    double middle = 0.0, slope = 0.0, bend = 0.0;  // a, b, c
    double rest = 0.0;                             // of the numbers, root mean square
    double bend_error = 0.0;                       // of c, one sigma
  };

  explicit Parabola(int size) : t_(static_cast<size_t>(size)) {
    for (int i = 0; i < size; ++i) t_[static_cast<size_t>(i)] = 2.0 * i / (size - 1) - 1.0;
    for (const double t : t_) squares_ += t * t;
    mean_square_ = squares_ / size;
    for (const double t : t_) fourths_ += Even(t) * Even(t);
  }

  Fit Through(const std::vector<double>& z) const {
    double sum = 0.0, odd = 0.0, even = 0.0, all = 0.0;
    for (size_t i = 0; i < t_.size(); ++i) {
      sum += z[i];
      odd += z[i] * t_[i];
      even += z[i] * Even(t_[i]);
      all += z[i] * z[i];
    }
    const auto size = static_cast<double>(t_.size());
    Fit fit;
    fit.slope = odd / squares_;
    fit.bend = even / fourths_;
    fit.middle = sum / size - fit.bend * mean_square_;
    const double left = all - sum * sum / size - odd * fit.slope - even * fit.bend;
    fit.rest = std::sqrt(std::max(left, 0.0) / (size - 3.0));
    fit.bend_error = fit.rest / std::sqrt(fourths_);
    return fit;
  }

 private:
  double Even(double t) const { return t * t - mean_square_; }

  std::vector<double> t_;
  double squares_ = 0.0, mean_square_ = 0.0, fourths_ = 0.0;
};

// The bend over that of a plane of this slope: 1 of a plane. Nothing where the surface is hardly
// slanted, falls away as an edge does, or is no smooth one.
std::optional<double> BendOfPlanes(const Parabola::Fit& fit) {
  constexpr double kLeastSlope = 0.05, kMostSlope = 0.6;     // of the distance, over half a window
  constexpr double kMostRest = 0.7, kMostError = 1.0 / 3.0;  // of a plane's bend
  const double slope = std::abs(fit.slope), plane = slope * slope / fit.middle;
  if (slope < kLeastSlope * fit.middle || slope > kMostSlope * fit.middle) return std::nullopt;
  if (fit.rest > kMostRest * plane || fit.bend_error > kMostError * plane) return std::nullopt;
  return fit.bend / plane;
}

}  // namespace

void SurfaceBend::AddLines(const DepthView& image, bool columns) {
  constexpr int kWindows = 10;   // side by side in a row
  constexpr int kLeastSize = 8;  // pixels
  constexpr int kLines = 160;    // of an image's width
  const int size = std::max(kLeastSize, image.width / kWindows);
  const int step = std::max(1, image.width / kLines), hop = size / 4;
  const int lines = columns ? image.width : image.height;
  const int length = columns ? image.height : image.width;
  const Parabola parabola(size);
  std::vector<double> z(static_cast<size_t>(size));
  for (int line = 0; line < lines; line += step) {
    for (int begin = 0; begin + size <= length; begin += hop) {
      ++windows_;
      for (int i = 0; i < size; ++i) {
        z[static_cast<size_t>(i)] = columns ? image.at(line, begin + i) : image.at(begin + i, line);
      }
      if (std::find(z.begin(), z.end(), 0.0) != z.end()) continue;
      const auto bend = BendOfPlanes(parabola.Through(z));
      if (bend && *bend > 0.4 && *bend < 1.8) ++as_planes_;
      if (bend && *bend > -8.0 && *bend < -0.1) ++opposite_;
    }
  }
}

void SurfaceBend::Add(const DepthView& image) {
  AddLines(image, false);
  AddLines(image, true);
}

bool SurfaceBend::IsWrongWayRound() const {
  constexpr double kEnough = 0.012;  // of the windows: a corner of a room has fewer
  constexpr int64_t kMostly = 3;     // to one
  return static_cast<double>(as_planes_ + opposite_) > kEnough * static_cast<double>(windows_) &&
         opposite_ > kMostly * as_planes_;
}

}  // namespace ossa::depth
