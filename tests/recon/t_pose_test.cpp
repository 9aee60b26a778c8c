#include "recon/t_pose.h"

#include <gtest/gtest.h>

#include "recon/posture.h"
#include "recon/skeleton.h"

namespace ossa::recon {
namespace {

BoneLengths SomeLengths() {
  BoneLengths lengths_m{};
  for (size_t j = 1; j < kJointCount; ++j) lengths_m[j] = 0.1 + 0.01 * static_cast<double>(j);
  return lengths_m;
}

TEST(TPose, HasTheGivenBoneLengths) {
  const BoneLengths wanted_m = SomeLengths();
  const BoneLengths made_m = MeasureBoneLengths(BuildTPose(wanted_m));
  for (size_t j = 1; j < kJointCount; ++j) EXPECT_NEAR(made_m[j], wanted_m[j], 1e-12) << j;
}

TEST(TPose, FacesForwardWithItsLeftArmToTheLeft) {
  const Posture pose = BuildTPose(SomeLengths());
  EXPECT_GT(pose[Joint::kHandLeft].x(), pose[Joint::kElbowLeft].x());  // x: its left
  EXPECT_LT(pose[Joint::kHandRight].x(), pose[Joint::kElbowRight].x());
  EXPECT_DOUBLE_EQ(pose[Joint::kHandLeft].y(), pose[Joint::kShoulderLeft].y());
  EXPECT_GT(pose[Joint::kHead].y(), 0.0);
  EXPECT_LT(pose[Joint::kAnkleRight].y(), pose[Joint::kKneeRight].y());
  EXPECT_GT(pose[Joint::kFootLeft].z(), pose[Joint::kAnkleLeft].z());
}

TEST(TPose, IsSymmetric) {
  for (size_t j = 4; j < 8; ++j) {
    EXPECT_EQ(TPoseDirection(j), -TPoseDirection(j + 4)) << "an arm's bone " << j;
  }
  EXPECT_EQ(TPoseDirection(Index(Joint::kHipLeft)), -TPoseDirection(Index(Joint::kHipRight)));
  for (size_t j = 13; j < 16; ++j) {
    EXPECT_EQ(TPoseDirection(j), TPoseDirection(j + 4)) << "a leg's bone " << j;
  }
}

}  // namespace
}  // namespace ossa::recon
