// Cameras under the ceiling: detection of the mount, and of people.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <optional>

#include "depth/image/depth_frame.h"
#include "depth/image/turn.h"
#include "recon/refine/refinement_cascade.h"
#include "tests/support/perceptrons.h"
#include "tests/support/refused.h"
#include "tests/support/temporary_folder.h"
#include "tests/tools/tracker/tracked_scenes.h"
#include "tools/people/detect_people.h"
#include "tools/synth/clothed_body.h"
#include "tools/synth/frame_maker.h"
#include "tools/synth/sequence_poses.h"
#include "tools/tracker/mount_finder_internal.h"

namespace ossa::tracker {
namespace {

using tools::LabelledFrame;

bool HasCeilingModel() {
  try {
    return !ShippedFile("body_ceiling.ossa").empty() &&
           !ShippedFile("body_ceiling.ossarefine").empty();
  } catch (const InputError&) {
    return false;
  }
}

#define OSSA_NEEDS_CEILING()                                                \
  if (!HasCeilingModel()) GTEST_SKIP() << "no shipped body_ceiling models"; \
  if (!recon::BodyIsFetched(recon::BodyFolder())) GTEST_SKIP() << "no body: tools/fetch_body"

// A camera, and the room that it sees.
struct Place {
  tools::View view;
  tools::Background background;
  uint64_t seed;
  bool is_clip;  // else a different body and camera in each image
};

// Images of a person in motion; a clip is by an Xtion, others by a Kinect v1.
std::vector<LabelledFrame> RenderFrames(const Place& place, int poses, int images) {
  tools::FrameOptions options;
  options.width = 320;
  options.height = 240;
  options.view = place.view;
  options.split = tools::Split::kTest;
  options.sequence = place.is_clip;
  if (place.is_clip) options.sensors = {depth::SensorKind::kXtion};
  options.background = place.background;
  options.seed = place.seed;
  const tools::FrameInputs inputs(
      tools::LoadFetchedBody(), tools::SequencePoses(AuthoredMotion(), poses, place.seed), options);
  tools::FrameMaker maker(inputs);
  std::vector<LabelledFrame> made;
  for (int i = 0; i < images; ++i) made.push_back(maker.Make(i));
  return made;
}

const std::vector<LabelledFrame>& CeilingClip() {
  static const std::vector<LabelledFrame> clip =
      RenderFrames({tools::View::kCeiling, tools::Background::kRoom, 2, true}, 10, 10);
  return clip;
}

// Hides everything below the middle of the trunk behind the front of a counter.
void PutBehindACounter(LabelledFrame& shot) {
  constexpr double kCounter_m = 0.45;  // by hand, from the hips to its front
  const recon::Posture& joints_m = shot.bodies[0].joints_m;
  const depth::Camera& camera = shot.depth.camera;
  const Eigen::Vector3d& spine_m = joints_m[recon::Joint::kSpine];
  const auto front_mm =
      static_cast<uint16_t>(1000.0 * (joints_m[recon::Joint::kHipCenter].z() - kCounter_m));
  const int top = static_cast<int>(camera.cy - camera.fy * spine_m.y() / spine_m.z());
  for (int v = std::clamp(top, 0, camera.height); v < camera.height; ++v) {
    for (int u = 0; u < camera.width; ++u) {
      uint16_t& depth_mm = shot.depth.depth_mm[static_cast<size_t>(v * camera.width + u)];
      if (depth_mm == 0 || depth_mm > front_mm) depth_mm = front_mm;
    }
  }
}

// The number of single images that are classified as from the ceiling.
int CountCeilings(const Place& place, int images, bool behind_a_counter = false) {
  Tracker tracker;
  int ceilings = 0;
  for (LabelledFrame& shot : RenderFrames(place, 300, images)) {
    if (behind_a_counter) PutBehindACounter(shot);
    tracker.Reset();
    tracker.Track(shot.depth);
    ceilings += tracker.mount() == Mount::kCeiling ? 1 : 0;
  }
  return ceilings;
}

// A person in front of a wall, without a visible floor: the wall is as flat and as far as a floor
// would be.
depth::DepthFrame BeforeAWall() {
  tests::CapsuleScene scene;
  scene.people = {PersonAt(0.0, 1.6)};
  scene.planes = {{-Eigen::Vector3d::UnitZ(), 3.0}};
  return tests::Render(scene, depth::KinectV1Camera(320, 240)).frame;
}

// Mean distance of joints from the truth in the clip.
struct ClipErrors {
  double visible_m = 0.0, all_m = 0.0;
  int refined = 0;  // frames with refined joints
};

ClipErrors TrackCeilingClip(Tracker tracker) {
  ClipErrors errors;
  int visible = 0, all = 0;
  for (const LabelledFrame& shot : CeilingClip()) {
    const BodyFrame seen = tracker.Track(shot.depth);
    EXPECT_EQ(tracker.mount(), Mount::kCeiling);
    EXPECT_EQ(seen.bodies.size(), 1U) << shot.depth.index;
    if (seen.bodies.empty()) continue;
    errors.refined += seen.bodies[0].refined ? 1 : 0;
    for (size_t j = 0; j < recon::kJointCount; ++j) {
      const double off_m =
          (seen.bodies[0].joints[j].position_m - shot.bodies[0].joints_m.position_m[j]).norm();
      errors.all_m += off_m;
      ++all;
      if (!shot.bodies[0].visible[j]) continue;
      errors.visible_m += off_m;
      ++visible;
    }
  }
  EXPECT_GT(visible, 50);
  errors.visible_m /= std::max(1, visible);
  errors.all_m /= std::max(1, all);
  return errors;
}

TEST(Mount, CeilingIsDetectedInTheFirstFrameWithOneBody) {
  OSSA_NEEDS_CEILING();
  EXPECT_LT(TrackCeilingClip(Tracker()).visible_m, 0.12);
}

// Of a camera on its side the lower border of the image is that of the turned image.
TEST(Mount, RotatedCameraIsCheckedInTheRotatedImage) {
  OSSA_NEEDS_CEILING();
  constexpr int kImages = 12;
  TrackerOptions turned;
  turned.turn = Turn::kQuarter;
  Tracker upright, on_its_side(turned);
  for (const LabelledFrame& shot :
       RenderFrames({tools::View::kCeiling, tools::Background::kLivedIn, 4, false}, 300, kImages)) {
    upright.Reset();
    on_its_side.Reset();
    upright.Track(shot.depth);
    on_its_side.Track(depth::Turned(shot.depth, 3));
    EXPECT_EQ(on_its_side.mount(), upright.mount()) << shot.depth.index;
  }
}

// With the weights of level cameras a part of a shelf is a second person.
TEST(Mount, UnderACeilingFurnitureDoesNotBecomeAPerson) {
  OSSA_NEEDS_CEILING();
  TrackerOptions under_ceiling;
  under_ceiling.mount = Mount::kCeiling;
  Tracker tracker(under_ceiling);
  const Place shop{tools::View::kCeiling, tools::Background::kLivedIn, 2, true};
  for (const LabelledFrame& shot : RenderFrames(shop, 240, 24)) {
    EXPECT_EQ(tracker.Track(shot.depth).bodies.size(), 1U) << shot.depth.index;
  }
}

TEST(Mount, CeilingCascadeReducesTheErrorOfJoints) {
  OSSA_NEEDS_CEILING();
  const ClipErrors with = TrackCeilingClip(Tracker());
  EXPECT_EQ(with.refined, static_cast<int>(CeilingClip().size()));
  ModelFiles files;
  files.refinement = "none";
  const ClipErrors without = TrackCeilingClip(Tracker(OptionsWith(files)));
  EXPECT_EQ(without.refined, 0);
  EXPECT_LT(with.all_m, without.all_m);
}

// A refinement that leaves joints where the forest has them.
recon::RefinementCascade SilentCascade(bool from_above) {
  recon::RefinementCascade cascade;
  cascade.people = 1;
  cascade.stages.emplace_back().fill(test::SilentPerceptron({recon::kStageFeatures, 3}));
  cascade.from_above = from_above;
  return cascade;
}

// A named cascade is for the mount that it was learned for; the other one keeps the shipped.
TEST(Mount, CascadeIsUsedForItsMountOnly) {
  OSSA_NEEDS_CEILING();
  const test::TemporaryFolder folder;
  ModelFiles files;
  files.refinement = folder / "named.ossarefine";
  const auto level = Rendered({PersonAt(0.0, 2.5)});
  const auto refined_at_level = [&level](const ModelFiles& of) {
    const BodyFrame seen = Tracker(OptionsWith(of)).Track(level.frame);
    EXPECT_EQ(seen.bodies.size(), 1U);
    return seen.bodies.empty() ? std::nullopt : seen.bodies[0].refined;
  };
  const auto shipped = refined_at_level({});
  ASSERT_TRUE(shipped);
  const ClipErrors with_shipped = TrackCeilingClip(Tracker());

  SilentCascade(true).Save(files.refinement);
  const auto of_above = refined_at_level(files);
  ASSERT_TRUE(of_above);
  EXPECT_EQ(of_above->position_m, shipped->position_m);
  const ClipErrors above = TrackCeilingClip(Tracker(OptionsWith(files)));
  EXPECT_EQ(above.refined, static_cast<int>(CeilingClip().size()));
  EXPECT_NE(above.all_m, with_shipped.all_m);

  SilentCascade(false).Save(files.refinement);
  const auto of_level = refined_at_level(files);
  ASSERT_TRUE(of_level);
  EXPECT_FALSE(of_level->position_m == shipped->position_m);
  EXPECT_EQ(TrackCeilingClip(Tracker(OptionsWith(files))).all_m, with_shipped.all_m);
}

TEST(Mount, CascadeOfAnotherMountIsRefusedWithoutReplacement) {
  OSSA_NEEDS_CEILING();
  const test::TemporaryFolder folder;
  ModelFiles files;
  files.forest = folder / "own.ossa";
  std::filesystem::copy_file(ModelOrNothing(), files.forest);
  files.refinement = folder / "named.ossarefine";
  SilentCascade(true).Save(files.refinement);
  test::ExpectRefused([&] { Tracker{OptionsWith(files)}; }, files.refinement + ": expected");
  TrackerOptions under_ceiling = OptionsWith(files);
  under_ceiling.mount = Mount::kCeiling;
  EXPECT_NO_THROW(Tracker{under_ceiling});
  SilentCascade(false).Save(files.refinement);
  EXPECT_NO_THROW(Tracker(OptionsWith(files)));
  under_ceiling.models = OptionsWith(files).models;
  test::ExpectRefused([&] { Tracker{under_ceiling}; }, files.refinement + ": expected");
}

TEST(Mount, CascadeOfTheCeilingForestIsUsedUnderTheCeilingOnly) {
  OSSA_NEEDS_CEILING();
  ModelFiles files;
  files.forest = ShippedFile("body_ceiling.ossa").string();
  EXPECT_EQ(TrackCeilingClip(Tracker(OptionsWith(files))).refined,
            static_cast<int>(CeilingClip().size()));
  TrackerOptions level = OptionsWith(files);
  level.mount = Mount::kLevel;
  EXPECT_NO_THROW(Tracker(level).Track(CeilingClip().front().depth));
}

TEST(Mount, UnderACeilingThePoseNetworkIsIgnored) {
  OSSA_NEEDS_CEILING();
  ModelFiles without;
  without.pose_network = "none";
  EXPECT_NE(ModelSet::Shipped().pose_network, nullptr);
  EXPECT_EQ(TrackCeilingClip(Tracker(OptionsWith(without))).all_m,
            TrackCeilingClip(Tracker()).all_m);
}

TEST(Mount, FloorFromAboveHasTheCamerasHeight) {
  OSSA_NEEDS_CEILING();
  TrackerOptions options;
  options.mount = Mount::kCeiling;
  const LabelledFrame& shot = CeilingClip().front();
  const BodyFrame seen = Tracker(options).Track(shot.depth);
  ASSERT_TRUE(seen.floor && shot.floor);
  EXPECT_NEAR((*seen.floor)[3], (*shot.floor)[3], 0.05);
  EXPECT_GT(seen.floor->head<3>().dot(shot.floor->head<3>()), 0.999);
}

// The floor, which detection needs there, is farther than the people.
TEST(Mount, UnderACeilingNearRangeFindsPeople) {
  OSSA_NEEDS_CEILING();
  TrackerOptions options;
  options.near_range = true;
  Tracker tracker(options);
  const BodyFrame seen = tracker.Track(CeilingClip().front().depth);
  EXPECT_EQ(tracker.mount(), Mount::kCeiling);
  EXPECT_EQ(seen.bodies.size(), 1U);
}

TEST(Mount, OptionLevelIsKept) {
  OSSA_NEEDS_CEILING();
  TrackerOptions options;
  options.mount = Mount::kLevel;
  Tracker tracker(options);
  for (const LabelledFrame& shot : CeilingClip()) tracker.Track(shot.depth);
  EXPECT_EQ(tracker.mount(), Mount::kLevel);
}

TEST(Mount, IsForgottenByReset) {
  OSSA_NEEDS_CEILING();
  Tracker tracker;
  tracker.Track(CeilingClip().front().depth);
  ASSERT_EQ(tracker.mount(), Mount::kCeiling);
  tracker.SetTurn(Turn::kHalf);
  tracker.Reset();
  EXPECT_EQ(tracker.mount(), Mount::kLevel);
  EXPECT_EQ(tracker.quarter_turns(), 2);
}

TEST(Mount, CeilingWithLagReturnsEachFrameOnce) {
  OSSA_NEEDS_CEILING();
  TrackerOptions options;
  options.lag = 2;
  Tracker tracker(options);
  std::vector<int64_t> told;
  depth::DepthFrame frame = CeilingClip().front().depth;
  for (frame.index = 0; frame.index < 5; ++frame.index) {
    frame.time_s = 1.1 * static_cast<double>(frame.index);  // so that each is checked
    if (frame.index < 2) frame.depth_mm.assign(frame.pixel_count(), 0);
    if (frame.index == 2) frame.depth_mm = CeilingClip().front().depth.depth_mm;
    if (const auto late = tracker.TrackWithLag(frame)) told.push_back(late->index);
  }
  ASSERT_EQ(tracker.mount(), Mount::kCeiling);
  while (const auto held = tracker.DrainLag()) told.push_back(held->index);
  EXPECT_EQ(told, (std::vector<int64_t>{0, 1, 2, 3, 4}));
  tracker.Reset();
  EXPECT_FALSE(tracker.DrainLag().has_value());
}

// A head near the camera with a wall far behind is as high above the wall as heads are above
// floors, but the body is cut off by the lower image border. Without that rule 10 of these 60 are
// classified as from the ceiling. In 2 of 600 such images furniture has the shape of a head.
TEST(Mount, LevelCameraWithANearPersonStaysLevel) {
  OSSA_NEEDS_CEILING();
  EXPECT_LE(CountCeilings({tools::View::kNear, tools::Background::kLivedIn, 5, false}, 60), 1);
}

// The counter hides the floor, and the person is not cut off by the lower image border: the wall
// behind them is like a floor seen from above. Where the level models are certain of a person, the
// ceiling forest must be so, too: without that rule 2 of these 60 are classified as from the
// ceiling.
TEST(Mount, LevelCameraWithAPersonBehindACounterStaysLevel) {
  OSSA_NEEDS_CEILING();
  EXPECT_LE(CountCeilings({tools::View::kFront, tools::Background::kLivedIn, 5, false}, 60, true),
            1);
}

TEST(Mount, LevelCameraInFrontOfAWallStaysLevel) {
  OSSA_NEEDS_MODEL();
  EXPECT_FALSE(MayBeFromAbove(BeforeAWall(), false, people::PeopleOptionsFromAbove()));
  Tracker tracker;
  depth::DepthFrame frame = BeforeAWall();
  for (int i = 0; i < 4; ++i) {
    frame.index = i;
    frame.time_s = i;
    tracker.Track(frame);
  }
  EXPECT_EQ(tracker.mount(), Mount::kLevel);
}

// In a furnished room a wall is often detected as the floor of a level camera, and no person in
// front of it: such frames are checked, too. The others show people at the image's border, or
// people of whom the level models are more certain: a clip decides on them in later checks.
TEST(Mount, CeilingIsDetectedIfAWallLooksLikeAFloor) {
  OSSA_NEEDS_CEILING();
  EXPECT_GE(CountCeilings({tools::View::kCeiling, tools::Background::kLivedIn, 2, false}, 24), 10);
}

// One image from the ceiling, then a person before a level camera on a floor.
TEST(Mount, WrongDecisionForTheCeilingIsTakenBack) {
  OSSA_NEEDS_CEILING();
  TrackerOptions options;
  options.lag = 1;
  Tracker tracker(options);
  depth::DepthFrame frame = CeilingClip().front().depth;
  ASSERT_FALSE(tracker.TrackWithLag(frame));
  ASSERT_EQ(tracker.mount(), Mount::kCeiling);
  frame.depth_mm = RenderFrames({tools::View::kFront, tools::Background::kRoom, 2, true}, 10, 1)
                       .front()
                       .depth.depth_mm;
  std::vector<int64_t> told;
  for (frame.index = 1; frame.index < 5; ++frame.index) {
    frame.time_s = 1.1 * static_cast<double>(frame.index);
    if (const auto late = tracker.TrackWithLag(frame)) told.push_back(late->index);
    EXPECT_EQ(tracker.mount(), frame.index < 3 ? Mount::kCeiling : Mount::kLevel) << frame.index;
  }
  const auto last = tracker.DrainLag();
  ASSERT_TRUE(last);
  EXPECT_EQ(last->bodies.size(), 1U);
  EXPECT_EQ(told, (std::vector<int64_t>{0, 1, 2, 3}));
}

}  // namespace
}  // namespace ossa::tracker
