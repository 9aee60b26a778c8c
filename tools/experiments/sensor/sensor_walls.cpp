// Noise of each simulated sensor at a perpendicular wall, against the closed form or published
// figures.
#include <fmt/format.h>

#include <cmath>

#include "depth/render/sensor_model.h"
#include "tools/experiments/sensor/sensor_statistics_internal.h"

namespace ossa::tools {
namespace {

// Constants: figures of the literature unless stated otherwise.

struct Walled {
  const char* sensor;
  depth::Camera camera;
  double (*published_mm)(double z_m);  // standard deviation; NaN: not published
  const char* source;
};

double KinectV2Deviation_mm(double z_m) { return 1.5 - 0.5 * z_m + 0.3 * z_m * z_m; }
// Of its maker's formula: 0.08 px of 1280, 65° wide, 55 mm apart.
double D415Deviation_mm(double z_m) {
  constexpr double kFocal_px = 1004.0, kBaseline_m = 0.055, kDisparity_px = 0.08;
  return 1000 * z_m * z_m * kDisparity_px / (kFocal_px * kBaseline_m);
}
double AzureLimit_mm(double /*z_m*/) { return 17.0; }
struct Wall {
  double deviation_mm = 0, read = 0;
};

/// In the middle third of the image, where illumination is even.
Wall Measure(const Walled& walled, double z_m, uint64_t seed) {
  const depth::Camera& camera = walled.camera;
  const int w = camera.width, h = camera.height;
  const depth::RenderedImage wall{
      {w, h, static_cast<float>(z_m)}, {w, h, 0}, {w, h, 0}, {w, h, 1.0F}, {w, h, 1}};
  const auto model = depth::MakeSensorModel(*depth::SensorFromName(walled.sensor));
  const auto image = depth::Simulate(model, wall, camera, camera, seed);
  double count = 0, sum = 0, squares = 0, all = 0;
  for (int v = h / 3; v < 2 * h / 3; ++v) {
    for (int u = w / 3; u < 2 * w / 3; ++u, ++all) {
      const double mm = image.depth_mm.at(u, v);
      if (mm > 0) ++count, sum += mm, squares += mm * mm;
    }
  }
  const double mean_mm = sum / count;
  return {std::sqrt(std::max(0.0, squares / count - mean_mm * mean_mm)), count / all};
}

}  // namespace

Table SensorsBeforeWalls(uint64_t seed) {
  const auto camera = [](int width, int height, double focal_px) {
    return depth::Camera{width, height, focal_px, focal_px, 0.5 * width, 0.5 * height};
  };
  const std::array<Walled, 3> kWalled = {
      {{"kinect-v2", camera(512, 424, 366), KinectV2Deviation_mm, "Fankhauser et al. 2015"},
       {"azure", camera(640, 576, 504), AzureLimit_mm, "at most, by specification"},
       {"d4xx", camera(1280, 720, 1004), D415Deviation_mm, "maker's formula, 0.08 px"}}};
  Table table{"Before a facing wall: standard deviation, mm",
              {"sensor", "1 m: published", "rendered", "2 m: published", "rendered",
               "4 m: published", "rendered", "read at 4 m, %", "published by"},
              {},
              "The middle third of the image. Nothing real is in this table: the simulated sensors "
              "beside what is published of their kinds. Structured light is held against real "
              "frames above."};
  for (const Walled& walled : kWalled) {
    std::vector<std::string> row{walled.sensor};
    double read = 0;
    for (const double z_m : {1.0, 2.0, 4.0}) {
      const Wall wall = Measure(walled, z_m, seed);
      row.push_back(NumberCell(walled.published_mm(z_m)));
      row.push_back(NumberCell(wall.deviation_mm));
      read = wall.read;
    }
    row.push_back(fmt::format("{:.1f}", 100 * read));
    row.emplace_back(walled.source);
    table.rows.push_back(std::move(row));
  }
  return table;
}

}  // namespace ossa::tools
