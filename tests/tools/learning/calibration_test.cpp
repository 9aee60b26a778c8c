#include "tools/learning/calibration.h"

#include <gtest/gtest.h>

#include <cmath>

namespace ossa::tools {
namespace {

TEST(Calibration, ErrorIsZeroForCalibratedConfidences) {
  Calibration calibration;
  for (int i = 0; i < 4; ++i) calibration.Count(0.75, i < 3);
  for (int i = 0; i < 4; ++i) calibration.Count(0.25, i < 1);
  EXPECT_DOUBLE_EQ(calibration.ExpectedError(), 0.0);
}

TEST(Calibration, ErrorWeighsOverconfidenceByTheNumberOfJoints) {
  Calibration calibration;
  for (int i = 0; i < 3; ++i) calibration.Count(0.95, i < 1);  // 0.617 too sure
  calibration.Count(0.05, false);                              // 0.05 too sure
  EXPECT_NEAR(calibration.ExpectedError(), (3 * 0.95 - 1 + 0.05) / 4, 1e-12);
}

TEST(Calibration, BinsAreTenthsWithBothEndsIncluded) {
  Calibration calibration;
  calibration.Count(0.0, false);
  calibration.Count(1.0, true);
  calibration.Count(0.62, true);
  calibration.Count(0.68, false);
  const auto bins = calibration.Bins();
  EXPECT_EQ(bins.front().joints, 1);
  EXPECT_EQ(bins.back().joints, 1);
  EXPECT_EQ(bins.back().hits, 1);
  EXPECT_EQ(bins[6].joints, 2);
  EXPECT_EQ(bins[6].hits, 1);
  EXPECT_NEAR(bins[6].mean_confidence, 0.65, 1e-12);
}

TEST(Calibration, ErrorIsAbsentWithoutJoints) {
  EXPECT_TRUE(std::isnan(Calibration().ExpectedError()));
}

}  // namespace
}  // namespace ossa::tools
