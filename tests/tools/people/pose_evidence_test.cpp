// Person scores by the errors of a pose network.
#include "tools/people/pose_evidence.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tools/people/options.h"

namespace ossa::people {
namespace {

recon::NetworkPose PoseOfError(double error_m) {
  recon::NetworkPose pose;
  pose.error_m.fill(error_m);
  return pose;
}

TEST(MeasureCertainty, IsOfTheFiveJointsThatTheNetworkIsSurestOf) {
  recon::NetworkPose pose = PoseOfError(1.0);
  EXPECT_NEAR(MeasureCertainty(pose), 0.0, 1e-12);
  for (const size_t joint : {3U, 7U, 12U, 13U, 19U}) pose.error_m[joint] = std::exp(-3.0);
  EXPECT_NEAR(MeasureCertainty(pose), 3.0, 1e-12);
  pose.error_m[3] = std::exp(-2.0);
  EXPECT_NEAR(MeasureCertainty(pose), 2.8, 1e-12);
}

TEST(ScoreWithPose, IncreasesWithBothScoresAndNeitherAloneDecides) {
  const double needed = InitiationOptions{}.person_by_pose_score;
  EXPECT_LT(ComputeScoreWithPose(0.5, 2.5), ComputeScoreWithPose(0.6, 2.5));
  EXPECT_LT(ComputeScoreWithPose(0.5, 2.5), ComputeScoreWithPose(0.5, 2.6));
  // A forest with a high score for furniture, and one with a low score for a person behind a board.
  EXPECT_LT(ComputeScoreWithPose(0.999, 1.7), needed);
  EXPECT_GT(ComputeScoreWithPose(0.3, 3.5), needed);
}

TEST(ScoreWithPose, IsFiniteForAnyForestScore) {
  EXPECT_EQ(ComputeScoreWithPose(0.0, 2.5), ComputeScoreWithPose(0.04, 2.5));
  EXPECT_EQ(ComputeScoreWithPose(1.0, 2.5), ComputeScoreWithPose(0.96, 2.5));
}

TEST(MeasureDistance, IsTheMeanOfTheJoints) {
  recon::NetworkPose a = PoseOfError(0.1), b = a;
  b.joints_m.position_m[5].x() += 2.0;
  EXPECT_NEAR(MeasureDistance_m(a, b), 2.0 / static_cast<double>(recon::kJointCount), 1e-12);
}

}  // namespace
}  // namespace ossa::people
