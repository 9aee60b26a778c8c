// From under the ceiling: when a camera hangs there, and that people are found then.
#include <gtest/gtest.h>

#include "depth/image/depth_frame.h"
#include "recon/motion/mocap.h"
#include "tests/tools/tracker/tracked_scenes.h"
#include "tools/people/detect_people.h"
#include "tools/synth/clothed_actor.h"
#include "tools/synth/frame_maker.h"
#include "tools/synth/sequence_poses.h"
#include "tools/tracker/mount_finder_internal.h"

namespace ossa::tracker {
namespace {

using tools::LabelledFrame;

bool HasCeilingModel() {
  try {
    return !ShippedFile("body_ceiling.ossa").empty();
  } catch (const InputError&) {
    return false;
  }
}

#define OSSA_NEEDS_CEILING()                                              \
  if (!HasCeilingModel()) GTEST_SKIP() << "no shipped body_ceiling.ossa"; \
  if (!recon::BodyIsFetched(recon::BodyFolder())) GTEST_SKIP() << "no body: tools/fetch_body"

// Somebody in motion in a room, from the ceiling.
const std::vector<LabelledFrame>& CeilingClip() {
  static const std::vector<LabelledFrame> clip = [] {
    constexpr int kFrames = 10;
    tools::FrameOptions options;
    options.width = 320;
    options.height = 240;
    options.view = tools::View::kCeiling;
    options.split = tools::Split::kTest;
    options.sequence = true;
    options.sensors = {depth::SensorKind::kXtion};
    options.background = tools::Background::kRoom;
    options.seed = 2;
    const tools::FrameStudio studio(
        tools::LoadFetchedBody(),
        tools::SequencePoses(recon::LoadMocap({"authored"}), kFrames, options.seed), options);
    tools::FrameMaker maker(studio);
    std::vector<LabelledFrame> made;
    for (int i = 0; i < kFrames; ++i) made.push_back(maker.Make(i));
    return made;
  }();
  return clip;
}

// A person before a wall, no floor in view: the wall is as flat and as far as a floor would be.
depth::DepthFrame BeforeAWall() {
  tests::CapsuleScene scene;
  scene.people = {PersonAt(0.0, 1.6)};
  scene.planes = {{-Eigen::Vector3d::UnitZ(), 3.0}};
  return tests::Render(scene, depth::KinectV1Camera(320, 240)).frame;
}

TEST(Mount, OfACeilingIsFoundOutInTheFirstFrameAndOneBodyWithIt) {
  OSSA_NEEDS_CEILING();
  Tracker tracker;
  double sum_m = 0.0;
  int joints = 0;
  for (const LabelledFrame& shot : CeilingClip()) {
    const BodyFrame seen = tracker.Track(shot.depth);
    EXPECT_EQ(tracker.mount(), Mount::kCeiling);
    ASSERT_EQ(seen.bodies.size(), 1U) << shot.depth.index;
    for (size_t j = 0; j < recon::kJointCount; ++j) {
      if (!shot.bodies[0].visible[j]) continue;
      sum_m += (seen.bodies[0].joints[j].position_m - shot.bodies[0].joints_m.position_m[j]).norm();
      ++joints;
    }
  }
  ASSERT_GT(joints, 50);
  EXPECT_LT(sum_m / joints, 0.12);
}

TEST(Mount, FromAboveThereIsAFloorAndItsHeightIsTheCameras) {
  OSSA_NEEDS_CEILING();
  TrackerOptions options;
  options.mount = Mount::kCeiling;
  const LabelledFrame& shot = CeilingClip().front();
  const BodyFrame seen = Tracker(options).Track(shot.depth);
  ASSERT_TRUE(seen.floor && shot.floor);
  EXPECT_NEAR((*seen.floor)[3], (*shot.floor)[3], 0.05);
  EXPECT_GT(seen.floor->head<3>().dot(shot.floor->head<3>()), 0.999);
}

TEST(Mount, SaidToBeLevelStaysSo) {
  OSSA_NEEDS_CEILING();
  TrackerOptions options;
  options.mount = Mount::kLevel;
  Tracker tracker(options);
  for (const LabelledFrame& shot : CeilingClip()) tracker.Track(shot.depth);
  EXPECT_EQ(tracker.mount(), Mount::kLevel);
}

TEST(Mount, IsForgottenWithEverybody) {
  OSSA_NEEDS_CEILING();
  Tracker tracker;
  tracker.Track(CeilingClip().front().depth);
  ASSERT_EQ(tracker.mount(), Mount::kCeiling);
  tracker.Reset();
  EXPECT_EQ(tracker.mount(), Mount::kLevel);
}

// A head near the camera with a wall far behind is as high over the wall as heads are over floors;
// but the body goes on below the image. Without that rule some of these change over.
TEST(Mount, OfALevelCameraWithSomebodyNearStaysLevel) {
  OSSA_NEEDS_CEILING();
  constexpr int kImages = 60;
  tools::FrameOptions options;
  options.width = 320;
  options.height = 240;
  options.view = tools::View::kNear;
  options.split = tools::Split::kTest;
  options.background = tools::Background::kLivedIn;
  options.seed = 5;
  const tools::FrameStudio studio(
      tools::LoadFetchedBody(),
      tools::SequencePoses(recon::LoadMocap({"authored"}), 300, options.seed), options);
  tools::FrameMaker maker(studio);
  Tracker tracker;
  for (int i = 0; i < kImages; ++i) {
    tracker.Reset();
    tracker.Track(maker.Make(i).depth);
    EXPECT_EQ(tracker.mount(), Mount::kLevel) << i;
  }
}

TEST(Mount, OfALevelCameraBeforeAWallStaysLevel) {
  OSSA_NEEDS_MODEL();
  EXPECT_FALSE(MayBeFromAbove(BeforeAWall(), people::PeopleOptionsFromAbove()));
  Tracker tracker;
  depth::DepthFrame frame = BeforeAWall();
  for (int i = 0; i < 4; ++i) {
    frame.index = i;
    frame.time_s = i;
    tracker.Track(frame);
  }
  EXPECT_EQ(tracker.mount(), Mount::kLevel);
}

TEST(Mount, IsAskedForOnceASecondAndNeverAfterALevelFloor) {
  MountFinder finder;
  BodyFrame tracked;
  EXPECT_TRUE(finder.IsDue(tracked));
  tracked.time_s = 0.5;
  EXPECT_FALSE(finder.IsDue(tracked));
  tracked.time_s = 1.1;
  EXPECT_TRUE(finder.IsDue(tracked));
  tracked.time_s = 3.0;
  tracked.floor = Eigen::Vector4d(0, 1, 0, 1);
  EXPECT_FALSE(finder.IsDue(tracked));
  tracked.time_s = 5.0;
  tracked.floor.reset();
  EXPECT_FALSE(finder.IsDue(tracked));
}

TEST(Mount, IsDecidedByTheFirstLookOrByThreeInARow) {
  MountFinder first;
  EXPECT_TRUE(first.Confirm(true));
  MountFinder later;
  EXPECT_FALSE(later.Confirm(false));
  EXPECT_FALSE(later.Confirm(true));
  EXPECT_FALSE(later.Confirm(false));
  EXPECT_FALSE(later.Confirm(true));
  EXPECT_FALSE(later.Confirm(true));
  EXPECT_TRUE(later.Confirm(true));
}

}  // namespace
}  // namespace ossa::tracker
