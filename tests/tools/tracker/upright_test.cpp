#include "tools/tracker/upright.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <numeric>
#include <utility>
#include <vector>

#include "depth/base/stopwatch.h"
#include "depth/image/turn.h"
#include "depth/sensor/frame_source.h"
#include "recon/fit/posed_surface.h"
#include "tests/tools/tracker/tracked_scenes.h"

namespace ossa::tracker {
namespace {

// The image of a camera that must be rotated by `quarters`.
depth::DepthFrame OfTurnedCamera(const depth::DepthFrame& upright, int quarters) {
  return depth::Turned(upright, (4 - quarters) % 4);
}

// A person who walks sideways, upright.
const std::vector<depth::DepthFrame>& Walk() {
  static const std::vector<depth::DepthFrame> frames = [] {
    std::vector<depth::DepthFrame> made;
    for (int i = 0; i < 6; ++i) made.push_back(Rendered({PersonAt(-0.2 + 0.03 * i, 2.6)}, i).frame);
    return made;
  }();
  return frames;
}

class Frames final : public depth::FrameSource {
 public:
  explicit Frames(std::vector<depth::DepthFrame> frames) : frames_(std::move(frames)) {}
  depth::ReadResult Read(std::chrono::milliseconds) override {
    depth::ReadResult result{.status = depth::ReadStatus::kEnd, .frame = {}};
    if (next_ == frames_.size()) return result;
    result.status = depth::ReadStatus::kFrame;
    result.frame = frames_[next_++];
    return result;
  }
  const depth::Camera& camera() const override { return frames_.front().camera; }
  bool is_live() const override { return false; }
  std::optional<int64_t> frame_count() const override { return std::nullopt; }

 private:
  std::vector<depth::DepthFrame> frames_;
  size_t next_ = 0;
};

void ExpectTurned(const recon::Posture& back, const recon::Posture& upright,
                  const Eigen::Matrix3d& turn, const char* what) {
  for (size_t j = 0; j < recon::kJointCount; ++j) {
    EXPECT_TRUE(back.position_m[j].isApprox(turn * upright.position_m[j], 1e-6)) << what << j;
  }
}

BodyFrame LastOf(Tracker& tracker, int quarters) {
  BodyFrame last;
  for (const depth::DepthFrame& frame : Walk()) {
    last = tracker.Track(OfTurnedCamera(frame, quarters));
  }
  return last;
}

// The same walk for an upright camera and one that must be rotated.
std::pair<BodyFrame, BodyFrame> UprightAndTurned(TrackerOptions options, int quarters) {
  Tracker upright(options);
  options.turn = static_cast<Turn>(quarters);
  Tracker turned(options);
  return {LastOf(upright, 0), LastOf(turned, quarters)};
}

// The first frame is searched in all four rotations, and for a ceiling view.
TEST(Upright, SearchTimeCountsInTheFramesTime) {
  TrackerOptions options;
  options.turn = Turn::kAuto;
  double best = 0.0;  // of three: a busy machine may stop between two clocks
  for (int i = 0; i < 3; ++i) {
    Tracker tracker(options);
    const Stopwatch watch;
    const StageTimes ms = tracker.Track(OfTurnedCamera(Walk().front(), 1)).ms;
    best = std::max(best, ms.total / watch.milliseconds());
  }
  EXPECT_GT(best, 0.9);
}

class TurnedCamera : public testing::TestWithParam<int> {};

TEST_P(TurnedCamera, ReturnsTheSamePeopleInItsOwnSpace) {
  OSSA_NEEDS_MODEL();
  const auto [upright, turned] = UprightAndTurned(PlainOptions(), GetParam());
  ASSERT_EQ(upright.bodies.size(), 1u);
  ASSERT_EQ(turned.bodies.size(), 1u);
  const Eigen::Matrix3d back = depth::CameraFromTurned(GetParam());
  const Eigen::Quaterniond rotation(back);
  for (size_t j = 0; j < recon::kJointCount; ++j) {
    const JointEstimate &a = upright.bodies[0].joints[j], &b = turned.bodies[0].joints[j];
    EXPECT_TRUE(b.position_m.isApprox(back * a.position_m, 1e-9)) << j;
    EXPECT_LT(b.orientation.angularDistance(rotation * a.orientation), 1e-6) << j;
  }
  EXPECT_TRUE(turned.floor->head<3>().isApprox(back * upright.floor->head<3>(), 1e-9));
  EXPECT_EQ(turned.users.data, depth::Turned(upright.users, (4 - GetParam()) % 4).data);
}

TEST_P(TurnedCamera, ReturnsEveryStageInItsOwnSpace) {
  OSSA_NEEDS_MODEL();
  const auto [upright, turned] = UprightAndTurned({}, GetParam());
  ASSERT_EQ(upright.bodies.size(), 1u);
  ASSERT_EQ(turned.bodies.size(), 1u);
  const Body &a = upright.bodies[0], &b = turned.bodies[0];
  ASSERT_TRUE(a.refined && a.fit && b.refined && b.fit);
  const Eigen::Matrix3d back = depth::CameraFromTurned(GetParam());
  ExpectTurned(b.raw.posture, a.raw.posture, back, "raw ");
  ExpectTurned(*b.refined, *a.refined, back, "refined ");
  ExpectTurned(b.fit->joints_m, a.fit->joints_m, back, "fitted ");
  ExpectTurned(b.fit->blended_m, a.fit->blended_m, back, "blended ");
  ExpectTurned(b.reconstructed, a.reconstructed, back, "reconstructed ");
  ExpectTurned(ToPosture(b), ToPosture(a), back, "final ");
  for (size_t j = 0; j < recon::kJointCount; ++j) {
    const Eigen::Matrix3d covariance_m2 = back * a.fit->covariance_m2[j] * back.transpose();
    EXPECT_TRUE(b.fit->covariance_m2[j].isApprox(covariance_m2, 1e-6)) << j;
  }
  const auto surface = recon::BodySurface::Load(ShippedFile("body.ossasurface"));
  recon::PosedSurface posed(surface);
  posed.PoseSegments(b.fit->pose);
  ExpectTurned(posed.Landmarks(), a.fit->joints_m, back, "of the pose ");
  for (size_t s = 0; s < recon::kSegmentCount; ++s) {
    EXPECT_TRUE(
        b.fit->camera_from_segment[s].toRotationMatrix().isApprox(posed.camera_from(s), 1e-6))
        << s;
  }
}

TEST_P(TurnedCamera, IsDetectedBeforeTheFirstFrameIsTracked) {
  OSSA_NEEDS_MODEL();
  TrackerOptions options = PlainOptions();
  options.turn = Turn::kAuto;
  Tracker tracker(options);
  std::vector<depth::DepthFrame> frames;
  for (const auto& frame : Walk()) frames.push_back(OfTurnedCamera(frame, GetParam()));
  Frames source(frames);
  tracker.FindUpright(source);
  EXPECT_EQ(tracker.quarter_turns(), GetParam());
}

INSTANTIATE_TEST_SUITE_P(All, TurnedCamera, testing::Values(0, 1, 2, 3));

// Another recording, by a camera with another rotation.
TEST(Turn, IsDetectedAgainAfterAReset) {
  OSSA_NEEDS_MODEL();
  TrackerOptions options = PlainOptions();
  options.turn = Turn::kAuto;
  Tracker tracker(options);
  for (const int quarters : {1, 2, 0}) {
    std::vector<depth::DepthFrame> frames;
    for (const auto& frame : Walk()) frames.push_back(OfTurnedCamera(frame, quarters));
    Frames source(frames);
    tracker.FindUpright(source);
    EXPECT_EQ(tracker.quarter_turns(), quarters);
    tracker.Reset();
    EXPECT_EQ(tracker.quarter_turns(), 0);
  }
}

TEST(TurnBack, RotatesBordersBackToo) {
  BodyFrame frame;
  frame.bodies.resize(1);
  frame.bodies[0].clipped_edges = kClippedTop | kClippedRight;
  TurnBack(frame, 1);  // the top was left before
  EXPECT_EQ(frame.bodies[0].clipped_edges, kClippedLeft | kClippedTop);
}

// The score of somebody whom the image cuts off.
TurnScore Cut(double score) { return {.score = score, .is_doubtful = true}; }

// Searches frames a second apart, with these person scores.
int TurnsAfter(UprightFinder& finder, int frames, std::vector<double> scores, double from_s = 0) {
  for (int i = 0; i < frames; ++i) {
    depth::DepthFrame frame;
    frame.time_s = from_s + 1.5 * i;
    finder.Update(frame, [&](const depth::DepthFrame&, int turn) {
      return Cut(scores[static_cast<size_t>(turn)]);
    });
  }
  return finder.quarters();
}

TEST(UprightFinder, ThreeSearchesThatAgreeRotateTheImages) {
  UprightFinder finder;
  EXPECT_EQ(TurnsAfter(finder, 2, {0, 0, 0.9, 0}), 0);
  EXPECT_EQ(TurnsAfter(finder, 1, {0, 0, 0.9, 0}, 9), 2);
}

TEST(UprightFinder, ACertainUprightPersonDecides) {
  UprightFinder finder;
  EXPECT_EQ(TurnsAfter(finder, 9, {0.85, 0.99, 0, 0}), 0);
  EXPECT_TRUE(finder.is_sure());
}

// Person scores of a man at a desk, near and cut off by the image, in the first frames of the real
// video rotated by 90 degrees; the second rotation is upright.
constexpr std::array<std::array<double, 4>, 4> kNear = {{{0.98, 1.0, 0.0, 0.69},
                                                         {0.0, 1.0, 0.0, 0.96},
                                                         {0.99, 1.0, 0.0, 0.66},
                                                         {0.99, 1.0, 0.0, 0.64}}};

// Searches the first frames of kNear, in all of which a person is tracked; `upright`: the rotation
// in which they are upright.
int TurnsNear(int upright) {
  UprightFinder finder;
  for (size_t i = 0; i < kNear.size(); ++i) {
    depth::DepthFrame frame;
    frame.time_s = static_cast<double>(i) / 30.0;
    finder.Update(frame, [&](const depth::DepthFrame&, int turn) {
      return Cut(kNear[i][static_cast<size_t>((turn - upright + 5) % 4)]);
    });
    finder.NoteTracked(frame.time_s);
  }
  return finder.quarters();
}

TEST(UprightFinder, MeansDecideIfSeveralRotationsShowACertainPerson) {
  for (const int upright : {0, 1, 2, 3}) EXPECT_EQ(TurnsNear(upright), upright);
}

TEST(UprightFinder, LowScoresDecideNothing) {
  UprightFinder finder;
  EXPECT_EQ(TurnsAfter(finder, 9, {0, 0.7, 0, 0}), 0);
  EXPECT_EQ(TurnsAfter(finder, 9, {0.75, 0.85, 0, 0}, 20), 0);
  EXPECT_FALSE(finder.is_sure());
}

TEST(UprightFinder, AWrongRotationIsUndoneByACertainUprightPerson) {
  UprightFinder finder;
  EXPECT_EQ(TurnsAfter(finder, 3, {0, 0.9, 0, 0}), 1);
  EXPECT_EQ(TurnsAfter(finder, 3, {0.9, 0, 0, 0}, 20), 0);
}

// The number of rotations scored in `frames` at 30 Hz, with these person scores.
int CountScored(UprightFinder& finder, int frames, const std::vector<double>& scores,
                int first = 0) {
  int asked = 0;
  for (int i = first; i < first + frames; ++i) {
    depth::DepthFrame frame;
    frame.time_s = i / 30.0;
    finder.Update(frame, [&](const depth::DepthFrame&, int turn) {
      ++asked;
      return TurnScore{.score = scores[static_cast<size_t>(turn)]};
    });
  }
  return asked;
}

// Each of the four rotations costs as much as tracking: only the first search uses a single frame.
TEST(UprightFinder, FramesOfARecordingShareASearchWithoutPeople) {
  UprightFinder finder;
  std::vector<int> asked(60, 0);
  for (size_t i = 0; i < asked.size(); ++i) {
    depth::DepthFrame frame;
    frame.time_s = static_cast<double>(i) / 30.0;
    finder.Update(frame, [&](const depth::DepthFrame&, int) { return ++asked[i], TurnScore{}; });
  }
  EXPECT_EQ(asked[0], 4);
  EXPECT_EQ(std::accumulate(asked.begin() + 1, asked.end(), 0), 4);
  EXPECT_EQ(*std::max_element(asked.begin() + 1, asked.end()), 1);
}

TEST(UprightFinder, ASharedSearchRotatesTheImagesToo) {
  UprightFinder finder;
  CountScored(finder, 40, {0, 0, 0, 0});  // no people before the second search
  EXPECT_EQ(CountScored(finder, 40, {0, 0, 0.9, 0}, 40), 4 + 2 * 4);
  EXPECT_EQ(finder.quarters(), 2);
}

TEST(UprightFinder, SearchesOnceASecondWithoutPeople) {
  UprightFinder finder;
  EXPECT_EQ(CountScored(finder, 60, {0, 0, 0, 0}), 2 * 4);
}

TEST(UprightFinder, SearchesAgainAtOnceAfterAPersonInAnotherRotation) {
  UprightFinder finder;
  CountScored(finder, 2, {0, 0, 0.9, 0});
  EXPECT_EQ(finder.quarters(), 0);
  UprightFinder sooner;
  CountScored(sooner, 3, {0, 0, 0.9, 0});
  EXPECT_EQ(sooner.quarters(), 2);
}

// The start of every recording would take three frames longer.
TEST(UprightFinder, ScoresOneRotationOfAFirstPersonWhoIsWhole) {
  UprightFinder finder;
  EXPECT_EQ(CountScored(finder, 1, {0.9, 0.9, 0.9, 0.9}), 1);
  EXPECT_TRUE(finder.is_sure());
}

TEST(UprightFinder, SearchesNothingWhileAPersonIsTracked) {
  UprightFinder finder;
  int asked = 0;
  for (int i = 0; i < 60; ++i) {
    depth::DepthFrame frame;
    frame.time_s = i / 30.0;
    finder.NoteTracked(frame.time_s);
    finder.Update(frame, [&](const depth::DepthFrame&, int) { return ++asked, TurnScore{}; });
  }
  EXPECT_EQ(asked, 0);
}

}  // namespace
}  // namespace ossa::tracker
