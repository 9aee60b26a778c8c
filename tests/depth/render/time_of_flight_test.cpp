#include "depth/render/time_of_flight.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/depth/render/rendered_walls.h"

namespace ossa::depth {
namespace {

const Camera kCamera{.width = 256, .height = 212, .fx = 366, .fy = 366, .cx = 128, .cy = 106};

class FlightNoise : public testing::TestWithParam<double> {};

// 1.5 - 0.5 z + 0.3 z² mm, Fankhauser et al. 2015, of a Kinect v2; the model is within 0.3 mm of
// it, and rounding to millimetres adds 0.29 mm in squares.
TEST_P(FlightNoise, EqualsThePublishedNoiseOfAKinectV2) {
  const double z = GetParam();
  // Without fall-off: as in the middle of the image, where it was measured.
  const auto image =
      SimulateTimeOfFlight(WallAt(kCamera, static_cast<float>(z)), kCamera, {.fall_off = 0.0}, 3);
  const Spread spread = SpreadOf(image, kCamera.width, kCamera.height);
  EXPECT_NEAR(spread.deviation_mm, 1.5 - 0.5 * z + 0.3 * z * z, 0.4);
  EXPECT_NEAR(spread.mean_mm, 1000 * z, 0.2);
}

INSTANTIATE_TEST_SUITE_P(Distances, FlightNoise, testing::Values(1.0, 2.0, 3.0, 4.0));

TEST(TimeOfFlight, DarkAndGrazingSurfacesHaveNoReading) {
  RenderedImage dark = WallAt(kCamera, 3.0F);
  dark.reflectance = Image<float>(kCamera.width, kCamera.height, 0.02F);
  RenderedImage grazing = WallAt(kCamera, 3.0F);
  grazing.incidence = Image<float>(kCamera.width, kCamera.height, 0.03F);
  EXPECT_GT(ReadShare(SimulateTimeOfFlight(WallAt(kCamera, 3.0F), kCamera, {}, 1)), 0.999);
  EXPECT_LT(ReadShare(SimulateTimeOfFlight(dark, kCamera, {}, 1)), 0.05);
  EXPECT_LT(ReadShare(SimulateTimeOfFlight(grazing, kCamera, {}, 1)), 0.05);
}

TEST(TimeOfFlight, EdgesHaveFlyingPixels) {
  const RenderedImage step = StepAt(kCamera, 1.5F, 3.0F);
  const auto count = [&](const TimeOfFlightOptions& options) {
    int flying = 0;
    for (const uint16_t mm : SimulateTimeOfFlight(step, kCamera, options, 5).depth_mm.data) {
      flying += mm > 1700 && mm < 2900 ? 1 : 0;
    }
    return flying;
  };
  // The near column is four times as bright: it moves by 12 cm, the far one by more than half.
  EXPECT_NEAR(count({.found_out = 0.0}), kCamera.height, 0.1 * kCamera.height);
  EXPECT_NEAR(count({.found_out = 0.5}), kCamera.height / 2, 0.2 * kCamera.height);
  EXPECT_EQ(count({.spread = 0.0}), 0);
}

TEST(TimeOfFlight, ConcaveCornersAreFilledAndConvexOnesAreNot) {
  for (const float sign : {1.0F, -1.0F}) {
    RenderedImage corner = WallAt(kCamera, 2.0F);
    for (int v = 0; v < kCamera.height; ++v) {
      for (int u = 0; u < kCamera.width; ++u) {
        // 45°: as much nearer, or farther, as aside.
        corner.depth_m.at(u, v) =
            2.0F - sign * static_cast<float>(std::abs(u - 128)) * 2.0F / 366.0F;
      }
    }
    const auto image = SimulateTimeOfFlight(corner, kCamera, {}, 7);
    double sum_mm = 0;
    for (int v = 20; v < 192; ++v) sum_mm += image.depth_mm.at(128, v);
    // The surroundings are 6 cm nearer, a third of the way to where they count no more: of 60 mm
    // the share 0.6 · (2/3)².
    EXPECT_NEAR(sum_mm / 172, sign > 0 ? 1984 : 2000, 2);
  }
}

TEST(TimeOfFlight, LightFallsOffFromTheCentreAndEndsOutsideTheField) {
  const RenderedImage wall = WallAt(kCamera, 3.0F);
  const auto image = SimulateTimeOfFlight(wall, kCamera, {.fall_off = 8.0}, 9);
  const Spread corner = SpreadIn(image, 0, 0, 40, 40), middle = SpreadIn(image, 108, 86, 40, 40);
  EXPECT_GT(corner.deviation_mm, 1.3 * middle.deviation_mm);
  const auto lit = SimulateTimeOfFlight(wall, kCamera, {.reach_x_deg = 15, .reach_y_deg = 10}, 9);
  EXPECT_GT(lit.depth_mm.at(128, 106), 0);
  EXPECT_EQ(lit.depth_mm.at(20, 106), 0);
  EXPECT_EQ(lit.depth_mm.at(128, 20), 0);
}

TEST(TimeOfFlight, DependsOnTheSeedOnly) {
  const RenderedImage step = StepAt(kCamera, 1.5F, 3.0F);
  const auto image = SimulateTimeOfFlight(step, kCamera, {}, 1);
  EXPECT_EQ(image.depth_mm.data, SimulateTimeOfFlight(step, kCamera, {}, 1).depth_mm.data);
  EXPECT_NE(image.depth_mm.data, SimulateTimeOfFlight(step, kCamera, {}, 2).depth_mm.data);
}

}  // namespace
}  // namespace ossa::depth
