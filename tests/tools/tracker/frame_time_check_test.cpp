// Frame times that cannot be seconds are reported once.
#include "tools/tracker/frame_time_check.h"

#include <gtest/gtest.h>

#include "depth/scene/measure_scene.h"
#include "tools/tracker/mount_finder_internal.h"

namespace ossa::tracker {
namespace {

std::string WarningOfSteps(double step, int frames = 30) {
  FrameTimeCheck check;
  std::string warning;
  for (int f = 0; f < frames; ++f) {
    check.Add(1e6 + f * step);
    warning += check.TakeWarning().value_or("");
  }
  return warning;
}

TEST(FrameTimeCheck, SecondsOfCamerasAreRight) {
  for (const double rate_hz : {300.0, 30.0, 5.0, 0.5}) EXPECT_EQ(WarningOfSteps(1 / rate_hz), "");
}

TEST(FrameTimeCheck, MillisecondsAreReportedOnce) {
  EXPECT_EQ(WarningOfSteps(33.3),
            "frame times grow by 33.3 from frame to frame: expected seconds, after 2.5 of which "
            "nobody is known again; are they milliseconds?");
}

TEST(FrameTimeCheck, TimesThatHardlyGrowAreReportedOnce) {
  for (const double step : {3e-5, 0.0, -0.5}) {
    const std::string warning = WarningOfSteps(step);
    EXPECT_NE(warning.find("expected seconds of a camera"), std::string::npos) << step;
    EXPECT_EQ(warning.find("grow by"), warning.rfind("grow by")) << warning;
  }
}

TEST(FrameTimeCheck, FewFramesAreNotJudged) { EXPECT_EQ(WarningOfSteps(33.3, 4), ""); }

// The warning about somebody who walks at this speed before a camera of 5 frames a second, whose
// images are read at `read_hz`.
std::string WarningOfWalk(double speed_mps, double read_hz, int frames = 60) {
  constexpr double kTaken_hz = 5.0;
  FrameTimeCheck check;
  std::string warning;
  for (int f = 0; f < frames; ++f) {
    check.Add(f / read_hz);
    check.AddPeople({{1, {speed_mps * f / kTaken_hz, 0.0, 3.0}}, {2, {0.0, 0.0, 4.0}}});
    warning += check.TakeWarning().value_or("");
  }
  return warning;
}

TEST(FrameTimeCheck, PeopleTooFastForTheirFrameTimesAreReportedOnce) {
  const std::string warning = WarningOfWalk(1.2, 30.0);
  EXPECT_NE(warning.find("50 % of the time faster than 4 m/s"), std::string::npos) << warning;
  EXPECT_NE(warning.find("--fps"), std::string::npos) << warning;
  EXPECT_EQ(warning.find("people move"), warning.rfind("people move")) << warning;
}

TEST(FrameTimeCheck, PeopleWhoStandWalkOrRunAreNotReported) {
  for (const double speed_mps : {0.0, 1.2, 3.5}) EXPECT_EQ(WarningOfWalk(speed_mps, 5.0), "");
  EXPECT_EQ(WarningOfWalk(0.1, 30.0), "");
  EXPECT_EQ(WarningOfWalk(1.2, 30.0, 20), "");  // too few to judge
}

// Somebody else, at another place, did not move there.
TEST(FrameTimeCheck, AnotherPersonDidNotMove) {
  FrameTimeCheck check;
  for (int f = 0; f < 100; ++f) {
    check.Add(f / 30.0);
    check.AddPeople({{f, {f % 2 * 2.0, 0.0, 3.0}}});
  }
  EXPECT_FALSE(check.TakeWarning());
}

// Every time is after "no frame yet", also one long before the clock's zero.
TEST(FirstFrame, IsNewAtAnyTime) {
  for (const double time_s : {-1e12, -1e9, 0.0, 1e12}) {
    depth::SceneState scene;
    depth::DepthFrame frame;
    frame.camera = depth::KinectV1Camera(32, 24);
    frame.depth_mm.assign(32 * 24, 2000);
    frame.time_s = time_s;
    EXPECT_TRUE(depth::MeasureScene(frame, scene).fresh) << time_s;
    BodyFrame tracked;
    tracked.time_s = time_s;
    EXPECT_TRUE(MountFinder().IsDue(tracked)) << time_s;
  }
}

}  // namespace
}  // namespace ossa::tracker
