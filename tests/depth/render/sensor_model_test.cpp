#include "depth/render/sensor_model.h"

#include <gtest/gtest.h>

#include "tests/depth/render/rendered_walls.h"

namespace ossa::depth {
namespace {

TEST(SensorModel, EverySensorHasItsNameAndOtherNamesAreNone) {
  for (size_t i = 0; i < kSensorNames.size(); ++i) {
    ASSERT_TRUE(SensorFromName(kSensorNames[i]));
    EXPECT_EQ(static_cast<size_t>(*SensorFromName(kSensorNames[i])), i);
  }
  EXPECT_FALSE(SensorFromName("kinect-v3"));
}

class EverySensor : public testing::TestWithParam<SensorKind> {};

TEST_P(EverySensor, MeasuresAWallNearlyEverywhereAndWithoutBias) {
  const Camera camera = KinectV1Camera(320, 240);
  const auto image = Simulate(MakeSensorModel(GetParam()), WallAt(camera, 2.0F), camera, camera, 5);
  EXPECT_GT(ReadShare(image), 0.9);
  // A millimetre of rounding, or of the 12 mm steps' own bias.
  EXPECT_NEAR(SpreadOf(image, 320, 240).mean_mm, 2000.0, 1.5);
}

TEST_P(EverySensor, SourceIsTheSurfaceNearestToTheMeasurement) {
  const Camera camera = KinectV1Camera(320, 240);
  const RenderedImage step = StepAt(camera, 1.5F, 3.0F);
  const auto image = Simulate(MakeSensorModel(GetParam()), step, camera, camera, 9);
  int wrong = 0, read = 0;
  for (size_t i = 0; i < image.source.data.size(); ++i) {
    ASSERT_EQ(image.depth_mm.data[i] == 0, image.source.data[i] < 0);
    if (image.source.data[i] < 0) continue;
    ++read;
    const float named_m = step.depth_m.data[static_cast<size_t>(image.source.data[i])];
    const float other_m = 4.5F - named_m;
    const float measured_m = 1e-3F * image.depth_mm.data[i];
    wrong += std::abs(measured_m - named_m) > std::abs(measured_m - other_m) ? 1 : 0;
  }
  // Mixed windows of structured light keep the label of the pixel they began with.
  EXPECT_LT(wrong, read / 1000);
}

TEST_P(EverySensor, DependsOnTheSeedAlone) {
  const Camera camera = KinectV1Camera(160, 120);
  const RenderedImage step = StepAt(camera, 1.5F, 3.0F);
  const auto once = Simulate(MakeSensorModel(GetParam()), step, camera, camera, 1);
  EXPECT_EQ(once.depth_mm.data,
            Simulate(MakeSensorModel(GetParam()), step, camera, camera, 1).depth_mm.data);
  if (GetParam() == SensorKind::kNone) return;
  EXPECT_NE(once.depth_mm.data,
            Simulate(MakeSensorModel(GetParam()), step, camera, camera, 2).depth_mm.data);
}

INSTANTIATE_TEST_SUITE_P(Kinds, EverySensor,
                         testing::Values(SensorKind::kNone, SensorKind::kKinectV1,
                                         SensorKind::kXtion, SensorKind::kKinectV2,
                                         SensorKind::kAzure, SensorKind::kD4xx));

}  // namespace
}  // namespace ossa::depth
