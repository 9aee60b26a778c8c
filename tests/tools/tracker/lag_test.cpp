// Bodies some frames late: nothing is lost, times are right, and they are steadier.
#include "tests/tools/tracker/tracked_scenes.h"
#include "tools/tracker/lagged_bodies_internal.h"

namespace ossa::tracker {
namespace {

constexpr size_t kHead = recon::Index(recon::Joint::kHead);

/// One body a frame, which stands still but for its head.
BodyFrame FrameWith(int index, const std::map<int, double>& heads_m) {
  BodyFrame frame;
  frame.index = index;
  frame.time_s = index / 30.0;
  for (const auto& [id, x_m] : heads_m) {
    Body& body = frame.bodies.emplace_back();
    body.id = id;
    for (size_t j = 0; j < recon::kJointCount; ++j) {
      body.joints[j].position_m = Eigen::Vector3d(0.0, 0.1 * static_cast<double>(j), 2.0);
    }
    body.joints[kHead].position_m.x() = x_m;
  }
  return frame;
}

std::vector<BodyFrame> Late(int lag, const std::vector<BodyFrame>& frames) {
  LaggedBodies bodies(recon::LagOptions::Of(lag, false));
  std::vector<BodyFrame> out;
  for (size_t f = 0; f < frames.size(); ++f) {
    const auto late = bodies.Add(frames[f]);
    EXPECT_EQ(late.has_value(), f >= static_cast<size_t>(lag)) << f;
    if (late) out.push_back(*late);
  }
  while (const auto held = bodies.DrainLag()) out.push_back(*held);
  return out;
}

double HeadOf(const BodyFrame& frame, size_t body = 0) {
  return frame.bodies.at(body).joints[kHead].position_m.x();
}

class LaggedBy : public testing::TestWithParam<int> {};

TEST_P(LaggedBy, KeepsFramesTimesAndPeople) {
  std::vector<BodyFrame> seen;
  for (int f = 0; f < 12; ++f) {
    std::map<int, double> heads_m = {{1, 0.01 * f}};
    if (f == 4 || f == 5) heads_m.clear();             // nobody
    if (f >= 8) heads_m = {{2, -0.01 * f}, {3, 0.0}};  // others
    seen.push_back(FrameWith(f, heads_m));
  }
  const auto made = Late(GetParam(), seen);
  ASSERT_EQ(made.size(), seen.size());
  for (size_t f = 0; f < seen.size(); ++f) {
    EXPECT_EQ(made[f].index, seen[f].index);
    EXPECT_EQ(made[f].time_s, seen[f].time_s);
    ASSERT_EQ(made[f].bodies.size(), seen[f].bodies.size()) << f;
    for (size_t b = 0; b < seen[f].bodies.size(); ++b) {
      EXPECT_EQ(made[f].bodies[b].id, seen[f].bodies[b].id) << f;
      EXPECT_NEAR(HeadOf(made[f], b), HeadOf(seen[f], b), 1e-9) << f;  // all move steadily
    }
  }
}

TEST_P(LaggedBy, EqualsTheLagOfFiles) {
  std::vector<BodyFrame> seen;
  recon::SkeletonSequence sequence{"made up", {}};
  for (int f = 0; f < 15; ++f) {
    seen.push_back(FrameWith(f, {{1, f % 3 == 0 ? 0.01 : 0.0}}));
    recon::SkeletonFrame& frame = sequence.frames.emplace_back();
    frame.time_s = seen.back().time_s;
    frame.bodies.emplace_back().id = 1;
    for (size_t j = 0; j < recon::kJointCount; ++j) {
      auto& joint = frame.bodies[0].joints[j].emplace();
      joint.position_m = seen.back().bodies[0].joints[j].position_m;
    }
  }
  const auto options = recon::LagOptions::Of(GetParam(), false);
  const auto file = recon::SmoothSequence(sequence, options);
  const auto made = Late(GetParam(), seen);
  for (size_t f = 0; f < seen.size(); ++f) {
    EXPECT_DOUBLE_EQ(HeadOf(made[f]), file.frames[f].bodies[0].joints[kHead]->position_m.x()) << f;
  }
}

TEST_P(LaggedBy, RestartsAfterTheEndOfAStream) {
  LaggedBodies bodies(recon::LagOptions::Of(GetParam(), false));
  for (int f = 0; f < 5; ++f) bodies.Add(FrameWith(f, {{1, 0.0}}));
  while (bodies.DrainLag()) {
  }
  for (int f = 5; f < 8; ++f) bodies.Add(FrameWith(f, {{1, 0.01}}));
  const auto held = bodies.DrainLag();
  ASSERT_TRUE(held);
  EXPECT_NEAR(HeadOf(*held), 0.01, 1e-9);
}

TEST_P(LaggedBy, EqualsTheTrackersLag) {
  OSSA_NEEDS_MODEL();
  TrackerOptions options = PlainOptions();
  Tracker now(options);
  options.lag = GetParam();
  Tracker late(options);
  std::vector<BodyFrame> seen, made;
  for (int f = 0; f < 5; ++f) {
    const auto frame = Rendered({PersonAt(0.02 * f, 2.5)}, f, 0.005).frame;
    seen.push_back(now.Track(frame));
    if (const auto bodies = late.TrackWithLag(frame)) made.push_back(*bodies);
  }
  while (const auto held = late.DrainLag()) made.push_back(*held);
  ASSERT_EQ(made.size(), seen.size());
  for (size_t f = 0; f < seen.size(); ++f) EXPECT_EQ(made[f].time_s, seen[f].time_s);
  EXPECT_NE(ToPosture(made[2].bodies.at(0)).position_m, ToPosture(seen[2].bodies.at(0)).position_m);
  EXPECT_EQ(made[2].bodies[0].raw.posture.position_m, seen[2].bodies[0].raw.posture.position_m);
}

INSTANTIATE_TEST_SUITE_P(Frames, LaggedBy, testing::Values(1, 2),
                         testing::PrintToStringParamName());

TEST(LagOfATracker, IsAtMostTwoFrames) {
  TrackerOptions options;
  options.lag = 3;
  EXPECT_THROW(options.Check(), std::invalid_argument);
}

TEST(LaggedTracker, ResetDiscardsHeldFrames) {
  OSSA_NEEDS_MODEL();
  TrackerOptions options = PlainOptions();
  options.lag = 2;
  Tracker tracker(options);
  for (int f = 0; f < 4; ++f) tracker.TrackWithLag(Rendered({PersonAt(0.0, 2.5)}, f).frame);
  tracker.Reset();
  for (int f = 0; f < 2; ++f) {
    EXPECT_FALSE(tracker.TrackWithLag(Rendered({PersonAt(0.0, 2.5)}, f).frame).has_value()) << f;
  }
  EXPECT_EQ(tracker.DrainLag()->index, 0);
}

}  // namespace
}  // namespace ossa::tracker
