#include "tools/experiments/compare/absent_frames.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tools/experiments/compare/metrics.h"

namespace ossa::tools {
namespace {

using recon::SkeletonFrame;
using recon::SkeletonSequence;

// A person who stands still.
SkeletonSequence Standing(int frames, double step_s) {
  recon::BodyRecord body;
  body.id = 1;
  for (size_t j = 0; j < recon::kJointCount; ++j) {
    body.joints[j].emplace().position_m = {0.1 * static_cast<double>(j), 0, 2};
  }
  SkeletonSequence sequence{"standing", {}};
  for (int f = 0; f < frames; ++f) {
    SkeletonFrame frame;
    frame.frame = f;
    frame.time_s = f * step_s;
    frame.bodies = {body};
    sequence.frames.push_back(frame);
  }
  return sequence;
}

template <typename Keep>
SkeletonSequence Kept(SkeletonSequence sequence, Keep keep) {
  std::erase_if(sequence.frames, [&](const SkeletonFrame& frame) { return !keep(frame.frame); });
  return sequence;
}

double Missing(const SkeletonSequence& truth, const SkeletonSequence& result,
               const PairOptions& options = {}) {
  return Measure(PairUp(truth, result, options).at(0)).fraction_joints_missing.value();
}

constexpr double kStep_s = 1 / 30.0;

TEST(AbsentFrames, CountAsMissedAtBothEndsAndBetween) {
  const auto truth = Standing(60, kStep_s);
  const auto result =
      Kept(truth, [](int64_t f) { return f >= 6 && f < 54 && (f < 20 || f >= 32); });
  const ClipMetrics metrics = Measure(PairUp(truth, result).at(0));
  EXPECT_EQ(metrics.frames, 36);
  EXPECT_DOUBLE_EQ(*metrics.fraction_joints_missing, 24.0 / 60);
  EXPECT_DOUBLE_EQ(*metrics.fraction_joints_within_10cm, 36.0 / 60);
  EXPECT_DOUBLE_EQ(*metrics.map_10cm, 36.0 / 60);
  EXPECT_EQ(*metrics.mean_joint_error_cm, 0);
}

// An absent frame and a frame without bodies count the same.
TEST(AbsentFrames, CountAsFramesWithoutBodies) {
  const auto truth = Standing(60, kStep_s);
  const auto is_hard = [](int64_t f) { return f % 7 > 3; };
  auto empty = truth;
  for (auto& frame : empty.frames) {
    if (is_hard(frame.frame)) frame.bodies.clear();
  }
  const auto absent = Kept(truth, [&](int64_t f) { return !is_hard(f); });
  EXPECT_DOUBLE_EQ(Missing(truth, absent), Missing(truth, empty));
}

TEST(AbsentFrames, AreZeroForAResultOfAnotherFrameRate) {
  const auto truth = Standing(61, kStep_s);
  EXPECT_EQ(Missing(truth, Kept(truth, [](int64_t f) { return f % 3 == 0; })), 0);
  EXPECT_EQ(Missing(truth, Standing(121, kStep_s / 2)), 0);
}

// Motion capture at 100 Hz and a camera of 30 Hz that loses two seconds of six.
TEST(AbsentFrames, AreCountedAtTheFrameRateOfTheResult) {
  const auto truth = Standing(601, 0.01);
  const auto result = Kept(Standing(181, kStep_s), [](int64_t f) { return f < 60 || f >= 120; });
  EXPECT_DOUBLE_EQ(Missing(truth, result, {.time = TimeAlignment::kNone}), 60.0 / 181);
}

TEST(AbsentFrames, AreNotCountedWhereTheTruthIsUnknown) {
  const auto all = Standing(90, kStep_s);
  const auto hidden = [](int64_t f) { return f < 30 || f >= 60; };
  EXPECT_EQ(Missing(Kept(all, hidden), Kept(all, hidden)), 0);
  EXPECT_DOUBLE_EQ(Missing(Kept(all, hidden), Kept(all, [](int64_t f) { return f < 30; })), 0.5);
}

// Two devices rarely start and stop together.
TEST(AbsentFrames, AreNotCountedAtTheEndsOfAnotherClock) {
  const auto truth = Standing(90, kStep_s);
  auto result = Kept(truth, [](int64_t f) { return f < 60; });
  for (auto& frame : result.frames) frame.time_s += 1000.01;
  EXPECT_EQ(Missing(truth, result), 0);
}

TEST(AbsentFrames, AreNotAddedToAResultOfAnotherTime) {
  const auto truth = Standing(30, kStep_s);
  auto later = truth;
  for (auto& frame : later.frames) frame.time_s += 1000;
  EXPECT_TRUE(PairUp(truth, later, {.time = TimeAlignment::kNone}).at(0).time_s.empty());
}

TEST(AbsentFrames, AreCountedPerPerson) {
  auto truth = Standing(60, kStep_s);
  for (auto& frame : truth.frames) {
    auto other = frame.bodies[0];
    other.id = 2;
    for (auto& joint : other.joints) joint->position_m.x() += 3.0;
    if (frame.frame >= 40) frame.bodies.push_back(other);
  }
  const auto pairs = PairUp(truth, Kept(truth, [](int64_t f) { return f < 45; }));
  ASSERT_EQ(pairs.size(), 2u);
  EXPECT_DOUBLE_EQ(*Measure(pairs[0]).fraction_joints_missing, 15.0 / 60);
  EXPECT_DOUBLE_EQ(*Measure(pairs[1]).fraction_joints_missing, 15.0 / 20);
}

// Damaged times: thirty years between two frames are not filled.
TEST(AbsentFrames, AreAtMostTheFramesOfTheTruth) {
  auto truth = Standing(30, kStep_s);
  auto result = truth;
  truth.frames.back().time_s = 1e9;
  result.frames.back().time_s = 1e9 + 5;
  EXPECT_LE(PairUp(truth, result, {.time = TimeAlignment::kNone}).at(0).time_s.size(), 31u);
}

}  // namespace
}  // namespace ossa::tools
