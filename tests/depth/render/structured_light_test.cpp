#include "depth/render/structured_light.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

namespace ossa::depth {
namespace {

RenderedImage WallAt(const Camera& camera, float z_m) {
  const int w = camera.width;
  const int h = camera.height;
  return {{w, h, z_m}, {w, h, 0}, {w, h, 0}, {w, h, 1.0F}, {w, h, 1}};
}

// Farther away from left to right, by a tenth of its mean distance in all.
RenderedImage RampAround(const Camera& camera, double z_m) {
  RenderedImage ramp = WallAt(camera, 0.0F);
  for (int v = 0; v < camera.height; ++v) {
    for (int u = 0; u < camera.width; ++u) {
      ramp.depth_m.at(u, v) = static_cast<float>(z_m * (0.95 + 0.1 * u / camera.width));
    }
  }
  return ramp;
}

class SensorSteps : public testing::TestWithParam<double> {};

// Disparities are f b / z pixels in steps of 1/8 pixel: 2.9e-6 z² mm, as in real frames.
TEST_P(SensorSteps, GrowWithTheSquareOfTheDepth) {
  const Camera camera = KinectV1Camera(640, 480);
  const StructuredLightOptions options;
  const auto image =
      SimulateStructuredLight(RampAround(camera, GetParam() / 1000), camera, options, 3);
  std::set<uint16_t> values(image.depth_mm.data.begin(), image.depth_mm.data.end());
  values.erase(0);
  const double nearest_m = *values.begin() / 1000.0;
  const double farthest_m = *values.rbegin() / 1000.0;
  const double steps = camera.fx * options.baseline_m * (1 / nearest_m - 1 / farthest_m) / 0.125;
  // Every step between the two is met on a ramp as fine as this. Their depths are rounded to whole
  // millimetres: half of one at either end is a quarter of the finest step, of 4 mm.
  EXPECT_NEAR(static_cast<double>(values.size() - 1), steps, 0.5);
  EXPECT_GE(steps, 6.0);
}

INSTANTIATE_TEST_SUITE_P(Depths, SensorSteps, testing::Values(1200.0, 2000.0, 4000.0));

TEST(StructuredLight, MeasuresAWallWithoutBiasAndWithFewHoles) {
  const Camera camera = KinectV1Camera(320, 240);
  const auto image = SimulateStructuredLight(WallAt(camera, 2.0F), camera, {}, 5);
  double sum_mm = 0;
  int read = 0;
  for (const uint16_t depth_mm : image.depth_mm.data) {
    sum_mm += depth_mm;
    read += depth_mm > 0 ? 1 : 0;
  }
  EXPECT_GT(read, 0.99 * 320 * 240);
  // Standard error of the window noise: 6 mm over some 38 000 windows of half the variance; the
  // quantisation can shift the mean by a small part of the 12 mm step.
  EXPECT_NEAR(sum_mm / read, 2000.0, 1.0);
}

TEST(StructuredLight, ShadowsAndTooNearSurfacesHaveNoReading) {
  const Camera camera = KinectV1Camera(320, 240);
  RenderedImage dark = WallAt(camera, 2.0F);
  dark.lit = Image<uint8_t>(320, 240, 0);
  for (const auto& wall : {dark, WallAt(camera, 0.2F)}) {
    for (const uint16_t depth_mm : SimulateStructuredLight(wall, camera, {}, 1).depth_mm.data) {
      ASSERT_EQ(depth_mm, 0);
    }
  }
}

TEST(StructuredLight, DependsOnTheSeedOnly) {
  const Camera camera = KinectV1Camera(320, 240);
  const RenderedImage wall = WallAt(camera, 2.0F);
  const auto image = SimulateStructuredLight(wall, camera, {}, 1);
  EXPECT_EQ(image.depth_mm.data, SimulateStructuredLight(wall, camera, {}, 1).depth_mm.data);
  EXPECT_NE(image.depth_mm.data, SimulateStructuredLight(wall, camera, {}, 2).depth_mm.data);
}

TEST(StructuredLight, SourcesAreTheMeasuredSurfaces) {
  const Camera camera = KinectV1Camera(320, 240);
  RenderedImage step = WallAt(camera, 3.0F);
  for (int v = 0; v < 240; ++v) {
    for (int u = 160; u < 320; ++u) step.depth_m.at(u, v) = 1.5F;
  }
  const StructuredLightOptions options{.edge_mixed = 0.0};
  const auto image = SimulateStructuredLight(step, camera, options, 9);
  for (size_t i = 0; i < image.source.data.size(); ++i) {
    if (image.depth_mm.data[i] == 0) continue;
    const float surface_mm = step.depth_m.data[static_cast<size_t>(image.source.data[i])] * 1000.0F;
    // Noise and step at 3 m are 26 mm and less; the two surfaces are 1500 mm apart.
    ASSERT_NEAR(image.depth_mm.data[i], surface_mm, 120.0F);
  }
}

TEST(PerfectSensor, RoundsToTheMillimetreAndKeepsEveryPixel) {
  const Camera camera = KinectV1Camera(320, 240);
  const auto image = PerfectSensor(WallAt(camera, 1.2344F));
  EXPECT_EQ(image.depth_mm.at(7, 9), 1234);
  EXPECT_EQ(image.source.at(7, 9), 9 * 320 + 7);
}

}  // namespace
}  // namespace ossa::depth
