// Parts of a character against closed forms: what threatens a head, how strongly a pin pulls, what
// a foot's pin takes for noise, and about which axis a twisted joint turns back.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "physics/actor_internal.h"
#include "recon/orientation.h"
#include "tests/physics/person.h"

namespace ossa::physics {
namespace {

using Eigen::Vector3d;
using test::Lengths;
using test::StandingPerson;

// --- Threats.

ObjectState BallAt(const Vector3d& at_m, const Vector3d& velocity_m_s) {
  return {at_m, Eigen::Quaterniond::Identity(), velocity_m_s};
}

TEST(Threat, IsTheClosestApproachOfHeadAndObject) {
  const Vector3d head_m(0.1, 1.6, 2.0);
  // 0.3 m beside the head, 1.5 m before it, at 5 m/s.
  const auto found =
      ThreatTo(head_m, Vector3d::Zero(), BallAt(head_m + Vector3d(0.3, 0, 1.5), {0, 0, -5.0}));
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->time_s, 0.3, 1e-12);
  EXPECT_NEAR(found->distance_m, 0.3, 1e-12);
}

// A head that runs into a hanging ball is as threatened as one at which the ball flies.
TEST(Threat, DependsOnTheVelocityOfTheHeadRelativeToTheObjectOnly) {
  const Vector3d head_m(0.0, 1.6, 2.0), ball_m(0.2, 1.7, 3.2), flight_m_s(-0.5, -0.2, -4.0);
  const auto still = ThreatTo(head_m, Vector3d::Zero(), BallAt(ball_m, flight_m_s));
  ASSERT_TRUE(still);
  for (const Vector3d& common_m_s : {Vector3d(0, 0, 4), Vector3d(3, -1, 2), Vector3d(-2, 0, -6)}) {
    const auto moving = ThreatTo(head_m, common_m_s, BallAt(ball_m, flight_m_s + common_m_s));
    ASSERT_TRUE(moving) << common_m_s.transpose();
    EXPECT_NEAR(moving->time_s, still->time_s, 1e-12);
    EXPECT_NEAR(moving->distance_m, still->distance_m, 1e-12);
  }
  EXPECT_FALSE(ThreatTo(head_m, flight_m_s, BallAt(ball_m, flight_m_s))) << "moves along with it";
}

// --- Pins.

/// The impulse that a pin of a hand gives a weightless person in ten substeps, N s.
Vector3d ImpulseOfAPin(const Vector3d& away_m, double stiffness_n_m, double h_s) {
  OdeWorld ode;
  Character character(ode, ComputeSegments(Lengths()), {});
  character.Place(StandingPerson(), recon::ComputeOrientations(StandingPerson()));
  const size_t hand = recon::Index(recon::Joint::kHandLeft);
  Pin pin(ode, character, hand, Anchor{character.JointPosition(hand) + away_m}, stiffness_n_m);
  for (uint64_t i = 0; i < 10; ++i) {
    pin.Update(h_s);
    SeededQuickStep(ode.world, h_s, i);
  }
  return character.Momentum();
}

// As a spring does, which is so soft that the hand hardly moves meanwhile.
TEST(Pin, PullsByItsStiffnessTimesTheDistanceUpToTwoCentimetres) {
  constexpr double kStiffness_n_m = 0.01, kSubstep_s = 1e-3;
  const Vector3d direction = Vector3d(1.0, 2.0, -2.0) / 3.0;
  for (const double distance_m : {0.005, 0.015, 0.02, 0.04, 1.0}) {
    const double expected_ns = kStiffness_n_m * std::min(distance_m, 0.02) * 10 * kSubstep_s;
    const Vector3d impulse = ImpulseOfAPin(distance_m * direction, kStiffness_n_m, kSubstep_s);
    EXPECT_LT((impulse - expected_ns * direction).norm(), 0.03 * expected_ns) << distance_m;
  }
}

/// The mean estimate of the noise of a foot's target that moves evenly and trembles, metres.
double EstimatedNoise_m(double sigma_m, const Vector3d& velocity_m_s) {
  OdeWorld ode;
  Character character(ode, ComputeSegments(Lengths()), {});
  character.Place(StandingPerson(), recon::ComputeOrientations(StandingPerson()));
  FootPin pin(15);
  std::mt19937_64 random(5);
  std::normal_distribution<double> normal(0.0, sigma_m);
  double sum_m = 0.0;
  constexpr int kFrames = 4000, kFrom = 100;
  for (int f = 0; f < kFrames; ++f) {
    const Vector3d noise_m =
        sigma_m > 0 ? Vector3d(normal(random), normal(random), normal(random)) : Vector3d::Zero();
    const Vector3d target_m =
        StandingPerson().position_m[15] + f * test::kFrame_s * velocity_m_s + noise_m;
    pin.Update(ode, character, test::Ground(), target_m, test::kFrame_s);
    if (f >= kFrom) sum_m += pin.memory.noise_m;
  }
  return sum_m / (kFrames - kFrom);
}

// Second differences of white noise have sqrt(6) its deviation per axis, in three axes a mean
// length of sqrt(8 / pi) deviations; their mean square gives sqrt(18).
TEST(FootPin, EstimatesTheNoiseOfItsTarget) {
  const double share = std::sqrt(6.0) * std::sqrt(8.0 / std::numbers::pi) / std::sqrt(18.0);
  for (const double sigma_m : {0.002, 0.008}) {
    const double noise_m = EstimatedNoise_m(sigma_m, {0.0, 0.0, 0.3});
    EXPECT_NEAR(noise_m, share * sigma_m, 0.03 * sigma_m);
  }
  EXPECT_NEAR(EstimatedNoise_m(0.0, {0.5, 0.0, 1.0}), 0.0, 1e-12) << "steady motion is none";
}

// --- Ranges.

/// Orientations at rest, but for a bone turned about its own axis.
recon::JointOrientations Twisted(size_t bone, double angle_rad) {
  recon::JointOrientations orientation = recon::RestOrientations();
  // Whatever way the whole body is turned.
  const Eigen::Quaterniond body(Eigen::AngleAxisd(0.7, Vector3d(1, 2, 3).normalized()));
  for (Eigen::Quaterniond& q : orientation) q = body * q;
  orientation[bone] = orientation[bone] * Eigen::AngleAxisd(angle_rad, Vector3d::UnitY());
  return orientation;
}

TEST(TwistExcess, TurnedBackAboutItsAxisABoneIsAtTheEndOfItsRange) {
  int tested = 0;
  for (const JointRange& range : JointRanges()) {
    if (range.twist_rad > 3.0) continue;  // unlimited
    for (const double sign : {1.0, -1.0}) {
      auto orientation = Twisted(range.bone, sign * (range.twist_rad + 0.3));
      const Excess excess = TwistExcess(range, orientation);
      EXPECT_NEAR(excess.angle_rad, 0.3, 1e-9) << range.bone;
      Eigen::Quaterniond& bone = orientation[range.bone];
      bone = Eigen::AngleAxisd(excess.angle_rad, excess.axis) * bone;
      EXPECT_NEAR(TwistExcess(range, orientation).angle_rad, 0.0, 1e-9) << range.bone;
      const auto expected = Twisted(range.bone, sign * range.twist_rad)[range.bone];
      EXPECT_LT(bone.angularDistance(expected), 1e-6) << range.bone << ", sign " << sign;
      ++tested;
    }
  }
  EXPECT_GE(tested, 14);
}

}  // namespace
}  // namespace ossa::physics
