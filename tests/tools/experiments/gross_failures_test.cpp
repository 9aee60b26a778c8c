#include "tools/experiments/sdk/gross_failures.h"

#include <gtest/gtest.h>

#include "recon/normalise.h"

namespace ossa::tools {
namespace {

using recon::Joint;

/// The standard stance, held still at 30 Hz, every joint reliable.
recon::SkeletonSequence Still(int frames) {
  recon::SkeletonSequence sequence{"still", {}};
  for (int f = 0; f < frames; ++f) {
    recon::SkeletonFrame frame;
    frame.frame = f;
    frame.time_s = f / 30.0;
    recon::BodyRecord& body = frame.bodies.emplace_back();
    for (size_t j = 0; j < recon::kJointCount; ++j) {
      body.joints[j].emplace().position_m = recon::StandardStance().position_m[j];
      body.joints[j]->reliability = 1.0;
    }
    sequence.frames.push_back(frame);
  }
  return sequence;
}

recon::JointRecord& At(recon::SkeletonSequence& sequence, size_t frame, Joint joint) {
  return *sequence.frames[frame].bodies[0].joints[joint];
}

TEST(GrossFailures, AreZeroForAPersonStandingStill) {
  const auto still = Still(10);
  const GrossFailures found = CountGrossFailures(still, still, still);
  EXPECT_EQ(found.frames, 10);
  EXPECT_EQ(found.jumps + found.snaps + found.wrong_bones + found.noticed, 0);
  EXPECT_EQ(found.jitter_cm, 0.0);
}

TEST(GrossFailures, CountAHandThatJumpsOntoTheOtherForOneFrame) {
  auto sequence = Still(10);
  auto& hand = At(sequence, 5, Joint::kHandLeft);
  hand.position_m = At(sequence, 5, Joint::kHandRight).position_m;
  auto judged = sequence;
  At(judged, 5, Joint::kHandLeft).reliability = 0.2;
  const GrossFailures found = CountGrossFailures(sequence, judged, sequence);
  EXPECT_EQ(found.snaps, 1);
  EXPECT_EQ(found.jumps, 2);        // there and back
  EXPECT_EQ(found.wrong_bones, 1);  // wrist to hand, in that frame
  EXPECT_EQ(found.noticed, 3);      // the jump there, the way back from it and the snap
  EXPECT_EQ(found.joints, 200);
  EXPECT_EQ(found.doubted, 1);
  EXPECT_GT(found.jitter_cm, 0.0);
}

TEST(GrossFailures, AreNotCountedAcrossGapsInTime) {
  auto sequence = Still(10);
  for (size_t f = 5; f < 10; ++f) {
    sequence.frames[f].time_s += 1.0;
    At(sequence, f, Joint::kHandLeft).position_m.y() += 0.5;
  }
  const GrossFailures found = CountGrossFailures(sequence, sequence, sequence);
  EXPECT_EQ(found.jumps, 0);
  EXPECT_EQ(found.jitter_cm, 0.0);
}

// A joint that a method has placed without an observation can be wrong as well.
TEST(GrossFailures, CountPlacedJointsThatAreNotTracked) {
  auto sequence = Still(10);
  auto& hand = At(sequence, 5, Joint::kHandLeft);
  hand.state = recon::TrackingState::kNotTracked;
  hand.position_m.y() += 0.5;
  EXPECT_EQ(CountGrossFailures(sequence, sequence, Still(10)).wrong_bones, 1);
  hand.reliability.reset();  // of a sensor: no position
  EXPECT_EQ(CountGrossFailures(sequence, sequence, Still(10)).wrong_bones, 0);
}

// A bone that a method stretches in every frame is wrong, even if its length is constant.
TEST(GrossFailures, CompareBonesWithThoseOfTheSensor) {
  const auto recording = Still(10);
  auto made = recording;
  for (size_t f = 0; f < 10; ++f) {
    auto& hand = At(made, f, Joint::kHandLeft).position_m;
    hand += 0.5 * (hand - At(made, f, Joint::kWristLeft).position_m);
  }
  EXPECT_EQ(CountGrossFailures(made, made, made).wrong_bones, 0);
  EXPECT_EQ(CountGrossFailures(made, made, recording).wrong_bones, 10);
}

TEST(GrossFailures, AddUpOverRecordings) {
  GrossFailures a{10, 1, 2, 3, 1, 100, 4, 0.5};
  a += GrossFailures{30, 2, 0, 1, 1, 200, 5, 0.1};
  EXPECT_EQ(a.frames, 40);
  EXPECT_EQ(a.jumps, 3);
  EXPECT_EQ(a.wrong_bones, 4);
  EXPECT_EQ(a.doubted, 9);
  EXPECT_NEAR(a.jitter_cm, (10 * 0.5 + 30 * 0.1) / 40, 1e-12);  // weighed by frames
}

}  // namespace
}  // namespace ossa::tools
