#include "recon/filters/lag_smoothing.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "recon/orientation.h"
#include "tests/recon/synthetic_motion.h"

namespace ossa::recon {
namespace {

constexpr double kFrame_s = 1.0 / 30.0;
constexpr size_t kHand = 7, kElbow = 5;

/// One person; `place` gives the hand's x, metres, by frame; everything else is static.
template <typename Place>
SkeletonSequence HandGoing(int frames, const Place& place) {
  SkeletonSequence sequence{"made up", {}};
  for (int f = 0; f < frames; ++f) {
    Posture posture = test::InFrontOfCamera(test::Motion(0.0));
    posture.position_m[kHand].x() = place(f);
    SkeletonFrame& frame = sequence.frames.emplace_back();
    frame.frame = f;
    frame.time_s = f * kFrame_s;
    BodyRecord& body = frame.bodies.emplace_back();
    body.id = 1;
    const JointOrientations turns = ComputeOrientations(posture);
    for (size_t j = 0; j < kJointCount; ++j) {
      body.joints[j].emplace().position_m = posture.position_m[j];
      body.joints[j]->orientation = turns[j];
    }
  }
  return sequence;
}

double HandAt(const SkeletonSequence& sequence, size_t f) {
  return sequence.frames[f].bodies.at(0).joints[kHand]->position_m.x();
}

class Lag : public testing::TestWithParam<int> {
 protected:
  LagOptions options_ = LagOptions::Of(GetParam(), false);
};

TEST_P(Lag, KeepsUniformMotion) {
  const auto seen = HandGoing(20, [](int f) { return 0.08 * f; });
  const auto made = SmoothSequence(seen, options_);
  for (size_t f = 0; f < 20; ++f) EXPECT_NEAR(HandAt(made, f), 0.08 * double(f), 1e-9) << f;
}

// One weight beside the frame's own 1 already halves the variance of a second difference; the
// written-out bound is that of weights 1/4, 1/2, 1/4: 70 / 256 / 6 of the squares, 21 % of lengths.
TEST_P(Lag, RemovesMostJitter) {
  std::mt19937_64 rng(5);
  std::normal_distribution<double> noise_m(0.0, 0.01);
  const auto seen = HandGoing(300, [&](int) { return noise_m(rng); });
  const auto made = SmoothSequence(seen, options_);
  double before = 0.0, after = 0.0;
  for (size_t f = 10; f < 290; ++f) {
    const auto second = [f](const SkeletonSequence& s) {
      return std::abs(HandAt(s, f + 1) - 2.0 * HandAt(s, f) + HandAt(s, f - 1));
    };
    before += second(seen), after += second(made);
  }
  EXPECT_LT(after, (GetParam() == 1 ? 0.45 : 0.25) * before);
}

// Loggers poll faster than the sensor delivers.
TEST_P(Lag, IgnoresRepeatedTimes) {
  std::mt19937_64 rng(6);
  std::normal_distribution<double> noise_m(0.0, 0.01);
  const auto once = HandGoing(60, [&](int) { return noise_m(rng); });
  SkeletonSequence twice{"made up", {}};
  for (const SkeletonFrame& frame : once.frames) {
    for (int i = 0; i < 2; ++i) twice.frames.push_back(frame);
  }
  const auto made_once = SmoothSequence(once, options_);
  const auto made_twice = SmoothSequence(twice, options_);
  for (size_t f = 0; f < 120; ++f) EXPECT_EQ(HandAt(made_twice, f), HandAt(made_once, f / 2)) << f;
}

// Two centimetres: the remaining influence of a pair of frames 30 cm apart on either side of the
// jump.
TEST_P(Lag, DoesNotSmearAJump) {
  const auto seen = HandGoing(20, [](int f) { return f < 10 ? 0.0 : 0.4; });
  const auto made = SmoothSequence(seen, options_);
  for (size_t f = 0; f < 20; ++f) EXPECT_NEAR(HandAt(made, f), HandAt(seen, f), 0.02) << f;
}

TEST_P(Lag, HandlesUnevenTimes) {
  auto seen = HandGoing(20, [](int f) { return 0.02 * f; });
  seen.frames.erase(seen.frames.begin() + 7);
  const auto made = SmoothSequence(seen, options_);
  for (size_t f = 0; f < made.frames.size(); ++f) {
    EXPECT_NEAR(HandAt(made, f), HandAt(seen, f), 1e-9) << f;
  }
}

TEST_P(Lag, EndsAtAGapAndAtAnotherPerson) {
  auto seen = HandGoing(20, [](int f) { return f % 2 == 0 ? 0.0 : 0.01; });
  for (size_t f = 10; f < 20; ++f) seen.frames[f].time_s += 0.5;
  seen.frames[5].bodies[0].id = 2;
  const auto made = SmoothSequence(seen, options_);
  for (const size_t f : std::vector<size_t>{0, 5, 9, 10, 19})
    EXPECT_EQ(HandAt(made, f), HandAt(seen, f)) << f;
  EXPECT_NE(HandAt(made, 2), HandAt(seen, 2));
}

TEST_P(Lag, LeavesAbsentJointsAbsent) {
  auto seen = HandGoing(9, [](int f) { return f % 2 == 0 ? 0.0 : 0.01; });
  seen.frames[4].bodies[0].joints[kHand].reset();
  const auto made = SmoothSequence(seen, options_);
  EXPECT_FALSE(made.frames[4].bodies[0].joints[kHand]);
  EXPECT_EQ(HandAt(made, 3), HandAt(seen, 3));
  EXPECT_TRUE(made.frames[4].bodies[0].joints[kElbow]);
}

TEST_P(Lag, KeepsBoneLengthsAndUpdatesOrientations) {
  std::mt19937_64 rng(5);
  std::normal_distribution<double> noise_m(0.0, 0.01);
  const auto seen = HandGoing(30, [&](int) { return noise_m(rng); });
  const auto made = SmoothSequence(seen, LagOptions::Of(GetParam(), true));
  for (size_t f = 0; f < 30; ++f) {
    const auto bone_m = [f](const SkeletonSequence& s) {
      const auto& joints = s.frames[f].bodies[0].joints;
      return Eigen::Vector3d(joints[kHand]->position_m - joints[ParentOf(kHand)]->position_m);
    };
    EXPECT_NEAR(bone_m(made).norm(), bone_m(seen).norm(), 1e-6) << f;
    const auto& turn = made.frames[f].bodies[0].joints[kHand]->orientation;
    const Eigen::Vector3d along = *turn * Eigen::Vector3d::UnitY();
    EXPECT_LT((along - bone_m(made).normalized()).norm(), 1e-6) << f;
  }
}

TEST(LagNone, ChangesNothing) {
  const auto seen = HandGoing(9, [](int f) { return f % 2 == 0 ? 0.0 : 0.01; });
  const auto made = SmoothSequence(seen, LagOptions::Of(0, true));
  for (size_t f = 0; f < 9; ++f) EXPECT_EQ(HandAt(made, f), HandAt(seen, f)) << f;
}

INSTANTIATE_TEST_SUITE_P(Frames, Lag, testing::Values(1, 2, kWholeRecording), [](const auto& info) {
  return info.param < 0 ? std::string("Whole") : std::to_string(info.param);
});

}  // namespace
}  // namespace ossa::recon
