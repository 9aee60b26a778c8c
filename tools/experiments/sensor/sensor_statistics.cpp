// Statistics of depth images that differ between sensors.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "depth/base/statistics.h"
#include "tools/experiments/sensor/sensor_statistics_internal.h"

namespace ossa::tools {
namespace {

// Constants: of the Kinect v1's images, by hand.

constexpr double kEdge_m = 0.15;  // a jump between two surfaces
constexpr int kLongestShadow_px = 80;

std::optional<size_t> FindBand(double depth_m) {
  for (size_t b = 0; b < kSensorBandCount; ++b) {
    if (depth_m >= kSensorBands_m[b] && depth_m < kSensorBands_m[b + 1]) return b;
  }
  return std::nullopt;
}

// Root mean square distance of 5 x 5 depths from their least-squares plane; nullopt at holes and
// jumps. On the regular grid the plane's slopes are independent sums.
std::optional<double> PlaneResidual_mm(const depth::Image<uint16_t>& image, int u, int v) {
  double sum = 0, along_u = 0, along_v = 0, squares = 0;
  const int middle = image.at(u, v);
  for (int dv = -2; dv <= 2; ++dv) {
    for (int du = -2; du <= 2; ++du) {
      const int z = image.at(u + du, v + dv);
      if (z == 0 || std::abs(z - middle) > 1e3 * kEdge_m) return std::nullopt;
      const double d = z - middle;  // small numbers, so that the squares keep their digits
      sum += d, along_u += du * d, along_v += dv * d, squares += d * d;
    }
  }
  constexpr double kCount = 25, kSlopes = 50;  // pixels; sum of squared offsets along one axis
  const double explained = sum * sum / kCount + (along_u * along_u + along_v * along_v) / kSlopes;
  return std::sqrt(std::max(0.0, squares - explained) / (kCount - 3));
}

// The projector is beside the camera: the unlit strip, f b (1/near - 1/far) pixels wide on one side
// of the near surface, has no reading.
void CountShadows(const depth::Image<uint16_t>& image, double focal_px, int v,
                  SensorStatistics& statistics) {
  constexpr double kBaseline_m = 0.075;  // Kinect v1: 75 mm
  for (int u = 1; u < image.width; ++u) {
    if (image.at(u, v) != 0 || image.at(u - 1, v) == 0) continue;
    int end = u;
    while (end < image.width && image.at(end, v) == 0) ++end;
    if (end == image.width || end - u > kLongestShadow_px) continue;
    const double left_m = 1e-3 * image.at(u - 1, v), right_m = 1e-3 * image.at(end, v);
    if (std::abs(left_m - right_m) < kEdge_m) continue;
    const double width_px = focal_px * kBaseline_m * std::abs(1.0 / left_m - 1.0 / right_m);
    if (width_px < 3) continue;  // as small as the noise of edges
    const bool near_follows = right_m < left_m;
    (near_follows ? statistics.left_shadows : statistics.right_shadows)
        .push_back((end - u) / width_px);
  }
}

// Two flat surfaces with one pixel between them in a row: is that pixel on one of them?
void CountEdge(const uint16_t* middle, SensorStatistics& statistics) {
  constexpr double kGap_mm = 300.0,
                   kOn = 0.15;  // share of the gap; a person before a wall, by hand
  const int left_mm = middle[-1], right_mm = middle[1];
  const double gap_mm = std::abs(left_mm - right_mm);
  if (middle[-2] == 0 || left_mm == 0 || right_mm == 0 || middle[2] == 0) return;
  if (gap_mm < kGap_mm || std::abs(middle[-2] - left_mm) > kOn * gap_mm ||
      std::abs(middle[2] - right_mm) > kOn * gap_mm) {
    return;
  }
  const double share = static_cast<double>(middle[0] - left_mm) / (right_mm - left_mm);
  ++statistics.edges;
  statistics.between += share > kOn && share < 1 - kOn;
}

}  // namespace

void Gather(const depth::Image<uint16_t>& image, double focal_px, SensorStatistics& statistics) {
  statistics.pixels += static_cast<int64_t>(image.data.size());
  for (int v = 2; v + 2 < image.height; ++v) {
    CountShadows(image, focal_px, v, statistics);
    for (int u = 2; u + 2 < image.width; ++u) {
      const uint16_t z = image.at(u, v);
      if (z == 0) {
        const std::array<int, 4> around = {image.at(u - 1, v), image.at(u + 1, v),
                                           image.at(u, v - 1), image.at(u, v + 1)};
        const auto [least, most] = std::minmax_element(around.begin(), around.end());
        statistics.pinholes += *least > 0 && *most - *least < 1e3 * kEdge_m;
        continue;
      }
      ++statistics.readings;
      CountEdge(&image.at(u, v), statistics);
      const auto band = FindBand(1e-3 * z);
      if (!band) continue;
      statistics.readings_mm[*band].push_back(z);
      if (u % 3 != 0 || v % 3 != 0) continue;  // neighbouring windows are redundant
      const auto residual = PlaneResidual_mm(image, u, v);
      if (residual) statistics.residuals_mm[*band].push_back(*residual);
    }
  }
}

double StepOverSquare(std::vector<uint16_t> readings_mm) {
  std::sort(readings_mm.begin(), readings_mm.end());
  std::vector<double> steps;
  for (size_t i = 1; i < readings_mm.size(); ++i) {
    const double z = readings_mm[i], step = z - readings_mm[i - 1];
    if (step > 0) steps.push_back(1e6 * step / (z * z));
  }
  return MedianOrNan(std::move(steps));
}

std::string NumberCell(double value) {
  return std::isnan(value) ? "-" : fmt::format("{:.2f}", value);
}

}  // namespace ossa::tools
