#include "recon/methods/recorded_pairs.h"

#include <gtest/gtest.h>

#include "tests/recon/noisy_sensor.h"

namespace ossa::recon {
namespace {

/// The same motion, recorded that often a second.
SkeletonSequence Recorded(double hz, double seconds = 10.0, double start_s = 0.0) {
  SkeletonSequence sequence;
  for (int f = 0; f < hz * seconds; ++f) {
    SkeletonFrame& frame = sequence.frames.emplace_back();
    frame.frame = f;
    frame.time_s = start_s + f / hz;
    frame.bodies.resize(1);
    const Posture posture = test::InFrontOfCamera(test::Motion(f / hz));
    for (size_t i = 0; i < kJointCount; ++i)
      frame.bodies[0].joints[i].emplace().position_m = posture.position_m[i];
  }
  return sequence;
}

double Largest_m(const std::vector<PosturePair>& pairs) {
  double largest = 0.0;
  for (const PosturePair& pair : pairs) largest = std::max(largest, pair.worst_m);
  return largest;
}

// All readers number frames from 0: recordings of different rates share numbers.
TEST(AddPairs, PairsByTimeForAnyFrameRates) {
  for (const double hz : {30.0, 25.0, 60.0, 100.0, 120.0}) {
    std::vector<PosturePair> pairs;
    EXPECT_GE(AddPairs(Recorded(30.0), Recorded(hz), pairs), 298U) << hz;
    EXPECT_LT(Largest_m(pairs), 0.005) << hz;
  }
}

TEST(AddPairs, DoesNotInterpolateTruthAcrossAGap) {
  SkeletonSequence truth = Recorded(60.0);
  truth.frames.erase(truth.frames.begin() + 120, truth.frames.begin() + 240);  // 2 to 4 s
  std::vector<PosturePair> pairs;
  const size_t count = AddPairs(Recorded(30.0), truth, pairs);
  EXPECT_NEAR(static_cast<double>(count), 240.0, 3.0);
  EXPECT_LT(Largest_m(pairs), 0.05);
}

// Two clocks, one of them 1 % slow, and the same frames: numbers tell which belong together.
TEST(AddPairs, PairsByNumberIfClocksDrift) {
  SkeletonSequence truth = Recorded(30.0);
  for (SkeletonFrame& frame : truth.frames) frame.time_s *= 1.01;
  std::vector<PosturePair> pairs;
  EXPECT_EQ(AddPairs(Recorded(30.0), truth, pairs), 300U);
  EXPECT_LT(Largest_m(pairs), 1e-9);
}

TEST(AddPairs, PairsNothingAtOtherTimes) {
  std::vector<PosturePair> pairs;
  EXPECT_EQ(AddPairs(Recorded(30.0), Recorded(60.0, 10.0, 1e6), pairs), 0U);
}

TEST(AddPairs, IgnoresUntrackedTruthJoints) {
  SkeletonSequence truth = Recorded(30.0);
  for (SkeletonFrame& frame : truth.frames) {
    JointRecord& hand = *frame.bodies[0].joints[7];
    hand.state = TrackingState::kNotTracked;
    hand.position_m.setZero();
  }
  std::vector<PosturePair> pairs;
  EXPECT_EQ(AddPairs(Recorded(30.0), truth, pairs), 300U);
  EXPECT_LT(Largest_m(pairs), 1e-9);
  for (const PosturePair& pair : pairs) EXPECT_EQ(pair.known[7], 0.0);
}

/// Two people in view at once, each recorded as if alone.
SkeletonSequence Together(SkeletonSequence a, const SkeletonSequence& b) {
  for (size_t f = 0; f < a.frames.size(); ++f) {
    BodyRecord other = b.frames[f].bodies[0];
    other.id = 1;
    for (auto& joint : other.joints) joint->position_m.x() += 1.5;
    a.frames[f].bodies.push_back(other);
  }
  return a;
}

// Filters are learned from consecutive frames.
TEST(AddPairs, KeepsThePairsOfAPersonTogether) {
  const test::SeenPerson a = test::Seen(0), b = test::Seen(1);
  const auto seen = Together(test::SequenceOf(a.seen), test::SequenceOf(b.seen));
  const auto truth = Together(test::SequenceOf(a.truth), test::SequenceOf(b.truth));
  std::vector<PosturePair> pairs;
  EXPECT_EQ(AddPairs(seen, truth, pairs), 600U);
  for (size_t i = 1; i < pairs.size(); ++i) {
    EXPECT_EQ(pairs[i].clip == pairs[i - 1].clip, i != 300) << i;
    if (i == 300) continue;
    EXPECT_GT(pairs[i].time_s, pairs[i - 1].time_s);
  }
}

}  // namespace
}  // namespace ossa::recon
