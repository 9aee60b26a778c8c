#include "recon/bone_lengths.h"

#include <gtest/gtest.h>

#include "recon/posture.h"
#include "recon/skeleton.h"

namespace ossa::recon {
namespace {

constexpr size_t kSpine = Index(Joint::kSpine);
constexpr size_t kLeft = Index(Joint::kElbowLeft);
constexpr size_t kRight = Index(Joint::kElbowRight);

TEST(BoneLengthEstimator, IsEmptyBeforeTheFirstMeasurement) {
  BoneLengthEstimator bones;
  EXPECT_EQ(bones.length_m(kSpine), 0.0);
  EXPECT_EQ(bones.measurements(kSpine), 0);
  bones.Start(kSpine, 0.2);
  EXPECT_EQ(bones.length_m(kSpine), 0.2);
  EXPECT_EQ(bones.measurements(kSpine), 0);
}

TEST(BoneLengthEstimator, IsTheMeanOfAllFrames) {
  BoneLengthEstimator bones(BoneLengthOptions::ForNetworkEstimates());
  BoneLengths lengths_m;
  lengths_m.fill(0.1);
  bones.Add(lengths_m);
  lengths_m.fill(0.4);
  bones.Add(lengths_m);
  bones.Add(lengths_m);
  EXPECT_EQ(bones.measurements(kSpine), 3);
  EXPECT_NEAR(bones.lengths_m()[kSpine], 0.3, 1e-12);
  EXPECT_EQ(bones.lengths_m()[0], 0.0);  // the root ends no bone
}

TEST(BoneLengthEstimator, ForgetsOldMeasurements) {
  BoneLengthEstimator bones({BoneStatistic::kMean, 10});
  for (int i = 0; i < 10; ++i) bones.Add(kSpine, 0.1);
  for (int i = 0; i < 100; ++i) bones.Add(kSpine, 0.4);
  EXPECT_EQ(bones.measurements(kSpine), 10);
  EXPECT_NEAR(bones.length_m(kSpine), 0.4, 1e-4);
}

TEST(BoneLengthEstimator, HardlyMovesKnownLengths) {
  BoneLengthEstimator bones({BoneStatistic::kMean, 100});
  BoneLengths known_m;
  known_m.fill(0.3);
  bones.StartKnown(known_m);
  EXPECT_EQ(bones.measurements(kSpine), 100);
  bones.Add(kSpine, 0.4);
  EXPECT_NEAR(bones.length_m(kSpine), 0.301, 1e-12);
}

TEST(BoneLengthEstimator, MovesByItsShareOfTheDifference) {
  BoneLengthEstimator bones(BoneLengthOptions::ForReferencePostures());
  bones.Start(kSpine, 0.2);
  bones.Add(kSpine, 0.3);
  EXPECT_NEAR(bones.length_m(kSpine), 0.21, 1e-12);
}

TEST(BoneLengthEstimator, MedianIsRobustAgainstAThirdOfOutliers) {
  BoneLengthEstimator running(BoneLengthOptions::ForJointDistances());
  BoneLengthEstimator exact(BoneLengthOptions::ForWholeRecording());
  BoneLengthEstimator mean(BoneLengthOptions::ForNetworkEstimates());
  for (int i = 0; i < 600; ++i) {
    const double measured_m = i % 3 == 2 ? 1.0 : 0.30;
    for (BoneLengthEstimator* bones : {&running, &exact, &mean}) bones->Add(kSpine, measured_m);
  }
  EXPECT_NEAR(running.length_m(kSpine), 0.30, 0.01);
  EXPECT_EQ(exact.length_m(kSpine), 0.30);
  EXPECT_GT(mean.length_m(kSpine), 0.5);
}

TEST(BoneLengthEstimator, AveragesBothSidesOnRequest) {
  BoneLengthEstimator alike({BoneStatistic::kMean, 600, 0.1, true});
  BoneLengthEstimator apart({BoneStatistic::kMean, 600, 0.1, false});
  for (BoneLengthEstimator* bones : {&alike, &apart}) {
    bones->Add(kLeft, 0.2);
    bones->Add(kRight, 0.4);
  }
  EXPECT_NEAR(alike.length_m(kLeft), 0.3, 1e-12);
  EXPECT_NEAR(alike.length_m(kRight), 0.3, 1e-12);
  EXPECT_EQ(alike.measurements(kRight), 2);
  EXPECT_EQ(apart.length_m(kLeft), 0.2);
  EXPECT_EQ(apart.length_m(kRight), 0.4);
}

}  // namespace
}  // namespace ossa::recon
