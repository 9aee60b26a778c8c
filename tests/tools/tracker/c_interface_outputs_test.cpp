// Results of the C interface beside the skeleton.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <optional>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "tests/support/temporary_folder.h"
#include "tests/tools/tracker/walk_in_c.h"

namespace ossa::tracker {
namespace {

using test::ImageOf;
using test::PlainOptionsInC;
using test::Says;
using test::Sized;
using test::WalkInC;

const float* HeadOf(const ossa_body& body) { return body.joints[OSSA_HEAD].position_m; }

ossa_body BodyOf(const ossa_tracker* tracker) {
  auto body = Sized<ossa_body>();
  EXPECT_EQ(ossa_tracker_body(tracker, 0, &body), OSSA_OK) << ossa_last_error();
  return body;
}

// Each image gives one frame, in order, equal to that of the C++ interface.
TEST(CInterface, LagDelaysAndSmoothsFrames) {
  OSSA_NEEDS_MODEL();
  TrackerOptions of_cpp = PlainOptions();
  of_cpp.lag = 2;
  Tracker cpp(of_cpp);
  ossa_options options = PlainOptionsInC();
  options.lag = 2;
  ossa_tracker* tracker = ossa_tracker_create(&options);
  ASSERT_NE(tracker, nullptr) << ossa_last_error();
  auto frame = Sized<ossa_frame>();
  const auto expect = [&](const std::optional<BodyFrame>& late, int64_t index) {
    ASSERT_TRUE(late && late->bodies.size() == 1);
    EXPECT_EQ(frame.index, index);
    EXPECT_EQ(frame.time_s, static_cast<double>(index) / 30.0);
    const auto& head = late->bodies[0].joints[recon::Joint::kHead];
    EXPECT_EQ(HeadOf(BodyOf(tracker))[0], static_cast<float>(head.position_m.x()));
  };
  for (int f = 0; f < 5; ++f) {
    const auto render = Rendered({PersonAt(0.03 * f, 2.5)}, f);
    const ossa_depth_image image = ImageOf(render.frame);
    const ossa_status status = ossa_tracker_track(tracker, &image, &frame);
    const auto late = cpp.TrackWithLag(render.frame);
    EXPECT_EQ(status, f < 2 ? OSSA_HELD : OSSA_OK) << f;
    EXPECT_EQ(frame.body_count, f < 2 ? 0 : 1) << f;
    if (late) expect(late, f - 2);
  }
  for (int f = 3; f < 5; ++f) {
    ASSERT_EQ(ossa_tracker_drain_lag(tracker, &frame), OSSA_OK) << ossa_last_error();
    expect(cpp.DrainLag(), f);
  }
  EXPECT_EQ(ossa_tracker_drain_lag(tracker, &frame), OSSA_END);
  ossa_tracker_destroy(tracker);
}

TEST(CInterface, InvalidLagIsRefused) {
  OSSA_NEEDS_MODEL();
  ossa_options options = PlainOptionsInC();
  options.lag = 3;
  EXPECT_EQ(ossa_tracker_create(&options), nullptr);
  EXPECT_TRUE(Says("lag = 3")) << ossa_last_error();
}

// A fitted person equals that of the C++ interface for the same image.
TEST(CInterface, FittedPersonHasShapeBonesAndMesh) {
  OSSA_NEEDS_MODEL();
  WalkInC walk(Sized<ossa_options>());
  const ossa_body body = walk.Next();
  Tracker tracker;
  const BodyFrame frame = tracker.Track(Rendered({PersonAt(0.0, 2.5)}).frame);
  const Body& of_cpp = frame.bodies.at(0);
  ASSERT_TRUE(of_cpp.fit && of_cpp.bones_m);
  EXPECT_EQ(body.has_fit, 1);
  EXPECT_EQ(body.explained, static_cast<float>(of_cpp.fit->explained));
  const auto& hand_m = of_cpp.fit->joints_m[recon::Joint::kHandLeft];
  EXPECT_EQ(body.fitted_m[OSSA_HAND_LEFT][1], static_cast<float>(hand_m.y()));
  EXPECT_EQ(body.has_bones, 1);
  EXPECT_EQ(body.bones_m[OSSA_KNEE_LEFT], static_cast<float>((*of_cpp.bones_m)[OSSA_KNEE_LEFT]));
  EXPECT_EQ(body.has_stature, 1);
  EXPECT_NEAR(body.stature_m, 1.7F, 0.3F);
  EXPECT_GT(body.stature_sigma_m, 0.0F);
  EXPECT_EQ(body.person_score, static_cast<float>(of_cpp.person_score));

  auto skin = Sized<ossa_skin>();
  ASSERT_EQ(ossa_tracker_skin(walk.tracker, 0, &skin), OSSA_OK) << ossa_last_error();
  EXPECT_EQ(skin.body_id, body.id);
  const uint32_t* const corners_end = skin.triangles + 3 * skin.triangle_count;
  EXPECT_EQ(*std::max_element(skin.triangles, corners_end) + 1,
            static_cast<uint32_t>(skin.vertex_count));
  // All of it is within reach of the person: half an arm span, by hand.
  for (int i = 0; i < skin.vertex_count; ++i) {
    const Eigen::Vector3f off_m = Eigen::Vector3f(skin.vertices_m + 3 * i) -
                                  Eigen::Vector3f(body.joints[OSSA_HIP_CENTER].position_m);
    ASSERT_LT(off_m.norm(), 1.2F) << i;
  }
}

TEST(CInterface, NoFitWithoutASurface) {
  OSSA_NEEDS_MODEL();
  auto options = Sized<ossa_options>();
  options.surface = "none";
  WalkInC walk(options);
  const ossa_body body = walk.Next();
  EXPECT_EQ(body.has_fit, 0);
  EXPECT_EQ(body.has_stature, 0);
  auto skin = Sized<ossa_skin>();
  EXPECT_EQ(ossa_tracker_skin(walk.tracker, 0, &skin), OSSA_FAILED);
  EXPECT_TRUE(Says("expected a surface and its skin, found 'none'")) << ossa_last_error();
  const test::TemporaryFolder folder;
  const std::string person = folder / "me.ossaperson";
  EXPECT_EQ(ossa_tracker_save_person(walk.tracker, 0, person.c_str()), OSSA_FAILED);
  EXPECT_TRUE(Says("expected a person to whom a body was fitted")) << ossa_last_error();
  options.person[0] = person.c_str();
  EXPECT_EQ(ossa_tracker_create(&options), nullptr);
  EXPECT_TRUE(Says("ossa_options.person: expected a body surface")) << ossa_last_error();
}

TEST(CInterface, CustomSurfaceUsesTheMeshNamedWithIt) {
  OSSA_NEEDS_MODEL();
  const std::string surface = ShippedFile("body.ossasurface"), mesh = ShippedFile("body.ossamesh");
  auto options = Sized<ossa_options>();
  options.surface = surface.c_str();
  auto skin = Sized<ossa_skin>();
  {
    WalkInC without(options);
    EXPECT_EQ(without.Next().has_fit, 1);
    EXPECT_EQ(ossa_tracker_skin(without.tracker, 0, &skin), OSSA_FAILED);
    EXPECT_TRUE(Says("expected ossa_options.mesh, the skin of ")) << ossa_last_error();
  }
  options.mesh = mesh.c_str();
  WalkInC with(options);
  with.Next();
  EXPECT_EQ(ossa_tracker_skin(with.tracker, 0, &skin), OSSA_OK) << ossa_last_error();
  EXPECT_GT(skin.vertex_count, 0);
  options.mesh = surface.c_str();  // no mesh
  EXPECT_EQ(ossa_tracker_create(&options), nullptr);
  EXPECT_TRUE(Says("body.ossasurface")) << ossa_last_error();
}

TEST(CInterface, PersonFileRestoresTheShape) {
  OSSA_NEEDS_MODEL();
  const test::TemporaryFolder folder;
  const std::string person = folder / "me.ossaperson";
  float sigma_m = 0.0F;
  {
    WalkInC walk(Sized<ossa_options>());
    sigma_m = walk.Next().stature_sigma_m;
    for (int i = 0; i < 4; ++i) walk.Next();
    ASSERT_EQ(ossa_tracker_save_person(walk.tracker, 0, person.c_str()), OSSA_OK)
        << ossa_last_error();
  }
  auto options = Sized<ossa_options>();
  options.person[0] = person.c_str();
  WalkInC again(options);
  EXPECT_LT(again.Next().stature_sigma_m, sigma_m);
}

TEST(CInterface, PartImageIsFilledOnRequest) {
  OSSA_NEEDS_MODEL();
  ossa_options options = PlainOptionsInC();
  WalkInC without(options);
  without.Next();
  EXPECT_EQ(without.frame.parts, nullptr);
  options.parts = 1;
  WalkInC walk(options);
  walk.Next();
  ASSERT_NE(walk.frame.parts, nullptr);
  EXPECT_EQ(walk.frame.width, 320);
  EXPECT_EQ(walk.frame.height, 240);
  std::set<std::string> seen;
  for (int i = 0; i < 320 * 240; ++i) seen.insert(ossa_part_name(walk.frame.parts[i]));
  EXPECT_TRUE(seen.contains("background") && seen.contains("LU head") && seen.contains("R hand"));
  EXPECT_EQ(ossa_part_name(33), nullptr);
  EXPECT_EQ(ossa_part_name(-1), nullptr);
}

TEST(CInterface, SceneObjectsAreReturned) {
  OSSA_NEEDS_MODEL();
  const test::TemporaryFolder folder;
  const std::string scene = folder / "ball.toml";
  std::ofstream(scene) << "floor = [0, 1, 0, 1]\n[[object]]\nname = \"ball\"\nshape = \"ball\"\n"
                          "size_m = 0.1\nmass_kg = 1\nat_m = [0.8, 1.5, 2]\n";
  ossa_options options = PlainOptionsInC();
  options.scene = scene.c_str();
  WalkInC walk(options);
  ASSERT_NE(walk.tracker, nullptr) << ossa_last_error();
  for (int i = 0; i < 15; ++i) walk.Next();  // objects wait until the floor was seen for 0.3 s
  ASSERT_EQ(walk.frame.object_count, 1);
  auto ball = Sized<ossa_object>();
  ASSERT_EQ(ossa_tracker_object(walk.tracker, 0, &ball), OSSA_OK) << ossa_last_error();
  EXPECT_STREQ(ball.name, "ball");
  EXPECT_NEAR(ball.position_m[0], 0.8F, 0.02F);
  EXPECT_LT(ball.velocity_m_s[1], -0.1F) << "it falls";
  EXPECT_EQ(ball.held_by_count, 0);
  EXPECT_EQ(ossa_tracker_object(walk.tracker, 1, &ball), OSSA_FAILED);
  EXPECT_TRUE(Says("expected a place below the frame's object_count, 1, found 1"));
  options.scene = "/nowhere.toml";
  EXPECT_EQ(ossa_tracker_create(&options), nullptr);
  EXPECT_TRUE(Says("/nowhere.toml")) << ossa_last_error();
}

// Each is created here, used in its own thread and destroyed in another; results are equal.
TEST(CInterface, TrackersWorkInSeveralThreadsAndCloseInAnyOrder) {
  OSSA_NEEDS_MODEL();
  std::array<ossa_tracker*, 3> trackers{};
  std::array<float, 3> head_m{};
  const ossa_options options = PlainOptionsInC();
  for (ossa_tracker*& tracker : trackers) tracker = ossa_tracker_create(&options);
  std::vector<std::thread> threads;
  for (size_t i = 0; i < trackers.size(); ++i) {
    threads.emplace_back([&, i] {
      EXPECT_STREQ(ossa_last_error(), "") << "another thread's";
      for (int f = 0; f < 3; ++f) {
        const auto render = Rendered({PersonAt(0.03 * f, 2.5)}, f);
        const ossa_depth_image image = ImageOf(render.frame);
        auto frame = Sized<ossa_frame>();
        EXPECT_EQ(ossa_tracker_track(trackers[i], &image, &frame), OSSA_OK) << ossa_last_error();
      }
      head_m[i] = HeadOf(BodyOf(trackers[i]))[0];
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(head_m[0], head_m[1]);
  EXPECT_EQ(head_m[0], head_m[2]);
  std::thread([&] { ossa_tracker_destroy(trackers[1]); }).join();
  ossa_tracker_destroy(trackers[0]);
  std::thread([&] { ossa_tracker_destroy(trackers[2]); }).join();
}

}  // namespace
}  // namespace ossa::tracker
