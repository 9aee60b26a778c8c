#include "recon/normalise.h"

#include <gtest/gtest.h>

#include <limits>

#include "tests/recon/synthetic_motion.h"

namespace ossa::recon {
namespace {

JointWeights Ones() {
  JointWeights w;
  w.fill(1.0);
  return w;
}

TEST(Normalise, InvertsPlacementAndRotation) {
  const Posture person = test::Gesture(0.4, 1.2, 0.5);
  for (const double yaw : {-3.0, -1.0, 0.0, 0.7, 3.1}) {
    const Posture seen = Placed(person, {{0.3, -0.2, 2.2}, yaw});
    const Placement placement = EstimatePlacement(seen, Ones(), 0.0);
    // The gesture's own hips and shoulders lie exactly across: rounding only.
    EXPECT_LT(test::MeanDistance_m(Normalised(seen, placement), person), 1e-12) << yaw;
  }
}

TEST(Normalise, APersonFacingTheCameraHasTheLeftHandAtNegativeX) {
  const Posture seen = test::InFrontOfCamera(test::Gesture(1.5, 1.5, 0.0));
  EXPECT_LT(seen[Joint::kHandLeft].x(), seen[Joint::kHandRight].x());
  EXPECT_NEAR(std::abs(EstimatePlacement(seen, Ones(), 0.0).yaw_rad), 3.1, 1e-9);
}

// A hip seen half a metre behind: unreliable, it does not count.
TEST(Normalise, TakesTheHeadingFromReliableJoints) {
  Posture seen = Placed(test::Gesture(0.4, 1.2, 0.5), {{0.3, -0.2, 2.2}, 0.7});
  seen[Joint::kHipRight] += Eigen::Vector3d(0.2, 0.0, 0.5);
  JointWeights weights = Ones();
  weights[Joint::kHipRight] = 0.0;
  EXPECT_NEAR(EstimatePlacement(seen, weights, 0.0).yaw_rad, 0.7, 1e-9);
}

TEST(Mirrored, ExchangesTheArms) {
  const Posture person = test::Gesture(0.4, 1.2, 0.5);
  EXPECT_LT(test::MeanDistance_m(Mirrored(person), test::Gesture(1.2, 0.4, 0.5)), 1e-12);
  EXPECT_GT(test::MeanDistance_m(Mirrored(person), person), 0.05);
}

TEST(Normalise, KeepsTheLastHeadingWithoutEvidence) {
  Posture seen;  // all joints at one point
  EXPECT_DOUBLE_EQ(EstimatePlacement(seen, Ones(), 1.25).yaw_rad, 1.25);
}

TEST(Retarget, KeepsDirectionsAndSetsBoneLengths) {
  const Posture person = test::Gesture(0.4, 1.2, 0.5, 0.3);
  for (const double scale : {0.9 / 1.66, 1.0, 2.2 / 1.66}) {
    const Posture other = Retargeted(person, ScaledBoneLengths(scale));
    const BoneLengths lengths = MeasureBoneLengths(other);
    for (size_t i = 1; i < kJointCount; ++i) {
      EXPECT_NEAR(lengths[i], scale * StandardBoneLengths()[i], 1e-12);
    }
    EXPECT_LT(test::MeanDistance_m(Retargeted(other, MeasureBoneLengths(person)), person), 1e-12);
  }
}

TEST(Retarget, UndefinedBonesGetTheRestDirection) {
  Posture collapsed;
  collapsed[Joint::kHead] = Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN());
  const Posture made = Retargeted(collapsed, StandardBoneLengths());
  for (const auto& p : made.position_m) EXPECT_TRUE(p.allFinite());
  EXPECT_GT(made[Joint::kHead].y(), made[Joint::kShoulderCenter].y());
}

// The trunk is of a child, the limbs of an adult: the joints that are not believed decide nothing.
TEST(BodyScale, IgnoresJointsWithoutWeight) {
  BoneLengths lengths = ScaledBoneLengths(1.2);
  JointWeights weights = Ones();
  for (size_t i = 4; i < kJointCount; ++i) {
    lengths[i] = 0.7 * StandardBoneLengths()[i];
    weights[i] = 0.01;
  }
  EXPECT_NEAR(EstimateBodyScale(lengths, weights), 1.2, 1e-9);
}

// Nine long bones of an adult, ten short ones of a child: half the length decides, not half the
// bones.
TEST(BodyScale, WeighsLongBonesMore) {
  BoneLengths lengths = ScaledBoneLengths(0.7);
  for (const size_t i : {2U, 5U, 6U, 9U, 10U, 13U, 14U, 17U, 18U}) {
    lengths[i] = 1.2 * StandardBoneLengths()[i];
  }
  EXPECT_NEAR(EstimateBodyScale(lengths, Ones()), 1.2, 1e-9);
}

TEST(BodyScale, IsRobustAgainstAWrongBone) {
  for (const double scale : {0.6, 1.0, 1.3}) {
    Posture person = Retargeted(test::Gesture(0.2, 0.3, 0.1), ScaledBoneLengths(scale));
    person[Joint::kHandLeft] += Eigen::Vector3d(0.8, 0.0, 0.0);
    EXPECT_NEAR(EstimateBodyScale(MeasureBoneLengths(person), Ones()), scale, 1e-9);
  }
}

}  // namespace
}  // namespace ossa::recon
