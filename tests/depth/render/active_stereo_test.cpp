#include "depth/render/active_stereo.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/depth/render/rendered_walls.h"

namespace ossa::depth {
namespace {

// A D415 at half of its width: 65° by data sheet.
const Camera kCamera{.width = 640, .height = 360, .fx = 502, .fy = 502, .cx = 320, .cy = 180};

SensorImage Sense(const RenderedImage& rendered, uint64_t seed,
                  const ActiveStereoOptions& options = {}) {
  return SimulateActiveStereo(rendered, kCamera, kCamera, options, seed);
}

/// Correlation of the errors of pixels at this distance along a row.
double Correlation(const SensorImage& a, const SensorImage& b, double true_mm, int apart_px) {
  double both = 0, squares = 0;
  for (int v = 0; v < kCamera.height; ++v) {
    for (int u = 60; u + apart_px < kCamera.width; ++u) {
      const double mm = a.depth_mm.at(u, v), other_mm = b.depth_mm.at(u + apart_px, v);
      if (mm == 0 || other_mm == 0) continue;
      both += (mm - true_mm) * (other_mm - true_mm);
      squares += (mm - true_mm) * (mm - true_mm);
    }
  }
  return both / squares;
}

class StereoNoise : public testing::TestWithParam<double> {};

// z² / (f b) of a disparity's 0.04 px: the formula of the sensor's maker with 0.08 px at full
// width. The noise grid's own variance varies by a few per cent over so few large blobs.
TEST_P(StereoNoise, GrowsWithTheSquareOfTheDepth) {
  const double z = GetParam();
  const auto image = Sense(WallAt(kCamera, static_cast<float>(z)), 3);
  const double expected_mm = 1000 * z * z / (502 * 0.055) * 0.04;
  const double deviation_mm = SpreadIn(image, 60, 0, 580, 360).deviation_mm;
  EXPECT_NEAR(deviation_mm, expected_mm, 0.12 * expected_mm + 0.3);
}

INSTANTIATE_TEST_SUITE_P(Distances, StereoNoise, testing::Values(1.0, 2.0, 4.0));

TEST(ActiveStereo, ErrorsAreCorrelatedInSpaceAndIndependentInTime) {
  const RenderedImage wall = WallAt(kCamera, 2.0F);
  const auto image = Sense(wall, 1), next = Sense(wall, 2);
  EXPECT_GT(Correlation(image, image, 2000, 2), 0.7);
  EXPECT_LT(Correlation(image, image, 2000, 60), 0.15);
  EXPECT_LT(std::abs(Correlation(image, next, 2000, 0)), 0.15);
}

TEST(ActiveStereo, HasABlackBandAtTheLeftAsWideAsTheDisparity) {
  const auto image = Sense(WallAt(kCamera, 1.0F), 1, {.dropout_per_m2 = 0.0});
  const int band_px = static_cast<int>(502 * 0.055 / 1.0);
  for (int v = 0; v < kCamera.height; v += 20) {
    for (int u = 0; u < band_px; ++u) ASSERT_EQ(image.depth_mm.at(u, v), 0) << u;
    ASSERT_GT(image.depth_mm.at(band_px + 2, v), 0);
  }
}

TEST(ActiveStereo, BlackBandOfACropIsThatOfTheWholeImage) {
  Camera crop = kCamera;
  crop.width = 100;
  crop.cx -= 10;  // begins at column 10 of the whole
  const auto image = SimulateActiveStereo(WallAt(crop, 1.0F), crop, kCamera, {}, 1);
  EXPECT_EQ(image.depth_mm.at(14, 100), 0);
  EXPECT_EQ(Sense(WallAt(kCamera, 1.0F), 1).depth_mm.at(24, 100), 0);
  EXPECT_GT(image.depth_mm.at(20, 100), 0);
}

TEST(ActiveStereo, NearSurfacesGrowByUpToHalfAWindowWithTheirLabel) {
  const RenderedImage step = StepAt(kCamera, 1.5F, 3.0F);
  const auto image = Sense(step, 4, {.smeared = 0.0, .edge_dropout = 0.0});
  int grown = 0;
  for (int v = 0; v < kCamera.height; ++v) {
    for (int u = 300; u < 320; ++u) {
      const uint16_t mm = image.depth_mm.at(u, v);
      if (mm == 0 || mm > 1700) continue;
      ++grown;
      ASSERT_GE(u, 320 - 4);
      ASSERT_NEAR(step.depth_m.data[static_cast<size_t>(image.source.at(u, v))], 1.5F, 1e-4F);
    }
  }
  EXPECT_GT(grown, kCamera.height);
}

TEST(ActiveStereo, SurfacesHiddenFromTheOtherImagerHaveNoReading) {
  RenderedImage hidden = WallAt(kCamera, 2.0F);
  hidden.lit = Image<uint8_t>(kCamera.width, kCamera.height, 0);
  EXPECT_EQ(ReadShare(Sense(hidden, 1)), 0.0);
}

TEST(ActiveStereo, IsDeterministicForASeed) {
  const RenderedImage step = StepAt(kCamera, 1.5F, 3.0F);
  EXPECT_EQ(Sense(step, 1).depth_mm.data, Sense(step, 1).depth_mm.data);
}

}  // namespace
}  // namespace ossa::depth
