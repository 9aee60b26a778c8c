#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "recon/filters/stationary_average.h"

namespace ossa::recon {
namespace {

using Eigen::Vector3d;

/// A joint observed with white noise on each axis.
class NoisyJoint {
 public:
  explicit NoisyJoint(double noise_m) : noise_(0.0, noise_m) {}
  Vector3d At(double x_m) {
    // Separate statements: argument evaluation order is unspecified.
    const double z_m = 3 + noise_(random_), y_m = noise_(random_);
    return {x_m + noise_(random_), y_m, z_m};
  }

 private:
  std::mt19937_64 random_{7};
  std::normal_distribution<double> noise_;
};

TEST(StationaryAverage, AveragesRestingJoints) {
  NoisyJoint joint(0.008);
  StationaryAverage average;
  double square_m2 = 0;
  constexpr int kSettled = 30, kFrames = 330;
  for (int i = 0; i < kFrames; ++i) {
    const Vector3d off = average.Step(joint.At(0)) - Vector3d(0, 0, 3);
    if (i >= kSettled) square_m2 += off.squaredNorm() / (kFrames - kSettled);
  }
  // Unfiltered it is 8 sqrt(3) = 14 mm; means of 16 frames and more are below 3.5, and one frame in
  // 200 may pass as it is.
  EXPECT_LT(std::sqrt(square_m2), 0.004);
}

TEST(StationaryAverage, ReleasesAStepInTheSameFrame) {
  constexpr double kNoise_m = 0.004, kStep_m = 0.05;
  NoisyJoint joint(kNoise_m);
  StationaryAverage average;
  for (int i = 0; i < 90; ++i) average.Step(joint.At(0));
  ASSERT_TRUE(average.held());
  // Half a second later the new place is averaged; until then each observation passes unchanged.
  for (int i = 0; i < 8; ++i) {
    const Vector3d seen = joint.At(kStep_m);
    EXPECT_EQ(average.Step(seen), seen) << i << " frames after the step";
  }
}

class StationaryRamp : public testing::TestWithParam<double> {};  // metres a second

TEST_P(StationaryRamp, IsReleasedEarlyAndThenHasNoLag) {
  constexpr double kNoise_m = 0.004;
  NoisyJoint joint(kNoise_m);
  StationaryAverage average;
  for (int i = 0; i < 90; ++i) average.Step(joint.At(0));
  const double step_m = GetParam() / 30;
  for (int i = 1; i <= 60; ++i) {
    const double x_m = i * step_m;
    const Vector3d seen = joint.At(x_m), out = average.Step(seen);
    // While averaged, the joint's error is at most the noise: three times that of one axis.
    EXPECT_LT(std::abs(out.x() - x_m), std::max(3 * kNoise_m, std::abs(seen.x() - x_m) + 1e-12))
        << "frame " << i;
    // Beyond twice the noise, 14 mm of three axes, nothing is averaged any more.
    if (x_m > 0.014) {
      EXPECT_EQ(out, seen) << "frame " << i;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Speeds, StationaryRamp, testing::Values(0.1, 0.3, 1.0),
                         [](const auto& info) {
                           return "cm" + std::to_string(std::lround(100 * info.param));
                         });

TEST(StationaryAverage, FollowsASwayingPerson) {
  // 2 cm to and fro in 10 seconds: never off by more than the noise of what is seen.
  constexpr double kNoise_m = 0.008;
  NoisyJoint joint(kNoise_m);
  StationaryAverage average;
  for (int i = 0; i < 600; ++i) {
    const double x_m = 0.01 * std::sin(2 * M_PI * i / 300);
    const Vector3d out = average.Step(joint.At(x_m));
    if (average.held()) {
      EXPECT_LT(std::abs(out.x() - x_m), 1.5 * kNoise_m) << "frame " << i;
    }
  }
}

TrackedPosture HeadSeenAt(const Vector3d& p) {
  TrackedPosture seen;
  seen.state.fill(TrackingState::kNotTracked);
  const auto head = Index(Joint::kHead);
  seen.state[head] = TrackingState::kTracked;
  seen.posture.position_m[head] = p;
  return seen;
}

TEST(StationaryPosture, RestartsAfterAGapAndKeepsStates) {
  NoisyJoint joint(0.008);
  StationaryPosture average;
  for (int i = 0; i < 40; ++i) average.Step(HeadSeenAt(joint.At(0)), i / 30.0);
  const auto seen = HeadSeenAt(joint.At(0));
  const auto held = average.Step(seen, 40 / 30.0);
  EXPECT_NE(held.posture[Joint::kHead], seen.posture[Joint::kHead]);
  EXPECT_EQ(held.state, seen.state);
  const auto later = HeadSeenAt(joint.At(0));
  EXPECT_EQ(average.Step(later, 5.0).posture[Joint::kHead], later.posture[Joint::kHead]);
}

// Times of a logger, which repeat and run back by a few milliseconds.
TEST(StationaryPosture, ContinuesWhenATimeRepeats) {
  NoisyJoint joint(0.008);
  StationaryPosture average;
  for (int i = 0; i < 40; ++i) average.Step(HeadSeenAt(joint.At(0)), i / 30.0);
  for (const double late_s : {0.0, 0.002}) {
    const auto seen = HeadSeenAt(joint.At(0));
    const auto held = average.Step(seen, 39 / 30.0 - late_s);
    EXPECT_NE(held.posture[Joint::kHead], seen.posture[Joint::kHead]);
  }
}

}  // namespace
}  // namespace ossa::recon
