// What the C interface hands out beside the skeleton, and what it writes.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <optional>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "depth/image/camera_presets.h"
#include "depth/image/depth_png.h"
#include "recon/files/skeleton_io.h"
#include "tests/support/depth_examples.h"
#include "tests/support/full_disk.h"
#include "tests/support/places.h"
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

// The frame of each image comes once, in order, and is that of the C++ interface.
TEST(CInterface, WithALagFramesComeLateAndSmoothed) {
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

TEST(CInterface, ALagThatCannotBeIsRefused) {
  OSSA_NEEDS_MODEL();
  ossa_options options = PlainOptionsInC();
  options.lag = 3;
  EXPECT_EQ(ossa_tracker_create(&options), nullptr);
  EXPECT_TRUE(Says("lag = 3")) << ossa_last_error();
}

// A person who was fitted: as the C++ interface says of the same image.
TEST(CInterface, AFittedPersonHasShapeBonesAndSkin) {
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

TEST(CInterface, WithoutASurfaceThereIsNoFit) {
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

TEST(CInterface, ASurfaceOfOnesOwnHasTheSkinThatIsNamedWithIt) {
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

TEST(CInterface, APersonIsKnownAgainByTheirFile) {
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

TEST(CInterface, PartsAreTherePixelByPixelForWhoAsks) {
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

TEST(CInterface, ThingsOfASceneAreTold) {
  OSSA_NEEDS_MODEL();
  const test::TemporaryFolder folder;
  const std::string scene = folder / "ball.toml";
  std::ofstream(scene) << "floor = [0, 1, 0, 1]\n[[object]]\nname = \"ball\"\nshape = \"ball\"\n"
                          "size_m = 0.1\nmass_kg = 1\nat_m = [0.8, 1.5, 2]\n";
  ossa_options options = PlainOptionsInC();
  options.scene = scene.c_str();
  WalkInC walk(options);
  ASSERT_NE(walk.tracker, nullptr) << ossa_last_error();
  for (int i = 0; i < 15; ++i) walk.Next();  // things wait until the floor was seen for 0.3 s
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

/// A walk of so many frames, written.
ossa_status WriteWalk(const std::string& path, int frames, ossa_options options = PlainOptionsInC(),
                      const ossa_writer_options* how = nullptr) {
  WalkInC walk(options);
  ossa_writer* writer = ossa_writer_open(path.c_str(), how);
  EXPECT_NE(writer, nullptr) << ossa_last_error();
  for (int i = 0; i < frames; ++i) {
    walk.Next();
    ossa_writer_write(writer, walk.tracker);
  }
  const ossa_status status = ossa_writer_finish(writer);
  ossa_writer_close(writer);
  return status;
}

TEST(CInterface, SkeletonsAreWritten) {
  OSSA_NEEDS_MODEL();
  const test::TemporaryFolder folder;
  const std::string path = folder / "walk.jsonl";
  ASSERT_EQ(WriteWalk(path, 3), OSSA_OK) << ossa_last_error();
  const recon::SkeletonSequence read = recon::ReadSkeletons(path);
  ASSERT_EQ(read.frames.size(), 3U);
  EXPECT_EQ(read.frames[2].frame, 2);
  ASSERT_EQ(read.frames[2].bodies.size(), 1U);
  EXPECT_TRUE(read.frames[2].bodies[0].joints[recon::Joint::kFootLeft]);
  WalkInC walk;
  EXPECT_NEAR(read.frames[0].bodies[0].joints[recon::Joint::kHead]->position_m.z(),
              HeadOf(walk.Next())[2], 1e-3);
}

// Joints that nobody looks for are not written, as by `ossa track --mode seated`.
TEST(CInterface, OfSeatedPeopleTheUpperJointsAreWritten) {
  OSSA_NEEDS_MODEL();
  const test::TemporaryFolder folder;
  const std::string path = folder / "walk.jsonl";
  ossa_options options = PlainOptionsInC();
  options.seated = 1;
  ASSERT_EQ(WriteWalk(path, 1, options), OSSA_OK) << ossa_last_error();
  const auto joints = recon::ReadSkeletons(path).frames.at(0).bodies.at(0).joints;
  EXPECT_TRUE(joints[recon::Joint::kHead]);
  EXPECT_FALSE(joints[recon::Joint::kFootLeft]);
}

TEST(CInterface, PeopleOfAGlbWearASkinUnlessTheyAreToWearNone) {
  OSSA_NEEDS_MODEL();
  const test::TemporaryFolder folder;
  const std::string dressed = folder / "dressed.glb", bare = folder / "bare.glb";
  auto how = Sized<ossa_writer_options>();
  ASSERT_EQ(WriteWalk(dressed, 2), OSSA_OK) << ossa_last_error();
  how.mesh = "none";
  how.names = "mixamo";
  ASSERT_EQ(WriteWalk(bare, 2, PlainOptionsInC(), &how), OSSA_OK) << ossa_last_error();
  EXPECT_GT(std::filesystem::file_size(dressed), 2 * std::filesystem::file_size(bare));
}

TEST(CInterface, WhatAWriterIsWronglyAskedForIsSaidInWords) {
  const test::TemporaryFolder folder;
  auto how = Sized<ossa_writer_options>();
  const auto refuses = [&](const char* name, const char* what) {
    const std::string path = folder / name;
    EXPECT_EQ(ossa_writer_open(path.c_str(), &how), nullptr) << name;
    EXPECT_TRUE(Says(what)) << ossa_last_error();
  };
  refuses("x.txt", "x.txt");
  how.posture = "best";
  refuses("x.jsonl",
          "posture: expected final, reconstructed, fitted, refined or raw, found 'best'");
  how.posture = nullptr;
  how.names = "sdk";
  refuses("x.glb", "names: expected cmu, mixamo or vrm, found 'sdk'");
  how.names = "vrm";
  refuses("x.csv", "names: expected a .bvh or .glb with them");
  how.names = nullptr;
  how.mesh = "none";
  refuses("x.bvh", "mesh: expected a .glb with them");
  how.mesh = nullptr;
  how.surface = "mine.ossasurface";
  refuses("x.glb", "surface: expected its skin with it");
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(CInterface, AWriterThatIsNotFinishedLeavesNothingAndAFinishedOneTakesNoMore) {
  OSSA_NEEDS_MODEL();
  const test::TemporaryFolder folder;
  const std::string path = folder / "walk.csv";
  WalkInC walk;
  walk.Next();
  ossa_writer* writer = ossa_writer_open(path.c_str(), nullptr);
  EXPECT_EQ(ossa_writer_write(writer, walk.tracker), OSSA_OK) << ossa_last_error();
  ossa_writer_close(writer);
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
  writer = ossa_writer_open(path.c_str(), nullptr);
  EXPECT_EQ(ossa_writer_write(writer, walk.tracker), OSSA_OK);
  EXPECT_EQ(ossa_writer_finish(writer), OSSA_OK) << ossa_last_error();
  EXPECT_EQ(ossa_writer_write(writer, walk.tracker), OSSA_FAILED);
  EXPECT_EQ(ossa_writer_finish(writer), OSSA_FAILED);
  EXPECT_TRUE(Says("expected a writer that is not finished")) << ossa_last_error();
  ossa_writer_close(writer);
  EXPECT_TRUE(std::filesystem::exists(path));
}

TEST(CInterface, OfAFullDiskWhatFitsIsKept) {
  OSSA_NEEDS_MODEL();
  const test::TemporaryFolder folder;
  const std::string path = folder / "walk.jsonl";
  {
    const test::FullDisk disk(30000);  // bytes; a frame has some 4 000
    EXPECT_EQ(WriteWalk(path, 12), OSSA_FAILED);
  }
  EXPECT_TRUE(Says("frames were kept")) << ossa_last_error();
  const size_t kept = recon::ReadSkeletons(path).frames.size();
  EXPECT_GT(kept, 2U);
  EXPECT_LT(kept, 12U);
}

TEST(CInterface, PixelsAndCameraSpaceMapBothWays) {
  depth::DepthFrame frame = Rendered({}).frame;
  const ossa_depth_image image = ImageOf(frame);
  std::vector<float> points_m(3 * frame.depth_mm.size());
  ASSERT_EQ(ossa_points(&image, points_m.data()), OSSA_OK) << ossa_last_error();
  const int u = 40, v = 200;
  const size_t pixel = static_cast<size_t>(v) * 320 + u;
  const float* point_m = &points_m[3 * pixel];
  ASSERT_GT(point_m[2], 0.5F);
  EXPECT_GT(point_m[0], 0.0F) << "x to the sensor's left";
  EXPECT_LT(point_m[1], 0.0F) << "y up";
  float uv[2] = {}, again_m[3] = {};
  ASSERT_EQ(ossa_project(&image, point_m, uv), OSSA_OK) << ossa_last_error();
  EXPECT_NEAR(uv[0], u, 1e-3);  // single precision
  EXPECT_NEAR(uv[1], v, 1e-3);
  ASSERT_EQ(ossa_back_project(&image, uv, frame.depth_mm[pixel], again_m), OSSA_OK);
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(again_m[i], point_m[i], 1e-5F);
  frame.depth_mm[pixel] = 0;
  ossa_points(&image, points_m.data());
  EXPECT_EQ(point_m[2], 0.0F);
  EXPECT_EQ(ossa_project(&image, point_m, uv), OSSA_FAILED);
  EXPECT_TRUE(Says("ossa_project: expected a point with z above 0")) << ossa_last_error();
  EXPECT_EQ(ossa_back_project(&image, uv, 0.0F, again_m), OSSA_FAILED);
}

// Left is left again, where the mirror had exchanged them.
TEST(CInterface, MirroredImagesAreTurnedBack) {
  const depth::DepthFrame frame = Rendered({PersonAt(0.4, 2.5)}).frame;
  ossa_depth_image image = ImageOf(frame);
  image.cx = 150.0;
  std::vector<uint16_t> depth_mm(frame.depth_mm);
  ASSERT_EQ(ossa_unmirror(&image, depth_mm.data()), OSSA_OK) << ossa_last_error();
  EXPECT_EQ(image.depth_mm, depth_mm.data());
  EXPECT_EQ(image.cx, 320 - 1 - 150.0);
  EXPECT_EQ(depth_mm[100 * 320 + 7], frame.depth_mm[100 * 320 + 312]);
  ASSERT_EQ(ossa_unmirror(&image, depth_mm.data()), OSSA_OK) << "where it is";
  EXPECT_EQ(depth_mm, frame.depth_mm);
  EXPECT_EQ(image.cx, 150.0);
  EXPECT_EQ(ossa_unmirror(&image, nullptr), OSSA_FAILED);
}

// A person as tall as there are, seen by a camera whose view is narrower than their images' size
// says.
TEST(CInterface, ANarrowerCameraIsFoundForWhoAsks) {
  OSSA_NEEDS_MODEL();
  const test::TemporaryFolder folder;
  tests::CapsuleScene scene;
  scene.people = {PersonAt(0.0, 2.6)};
  scene.people[0].height_m = 2.1;
  scene.planes = tests::EmptyRoom();
  const auto render = tests::Render(scene, depth::PresetCamera("d435-color", 640, 360));
  depth::WriteDepthPng(folder / "0.png", render.frame.view());
  auto options = Sized<ossa_source_options>();
  auto image = Sized<ossa_depth_image>();
  double guessed_px = 0.0;
  for (const int find : {0, 1}) {
    options.find_camera = find;
    ossa_source* source = ossa_source_open(folder.path().c_str(), &options);
    ASSERT_NE(source, nullptr) << ossa_last_error();
    ASSERT_EQ(ossa_source_read(source, 1000, &image), OSSA_OK) << ossa_last_error();
    if (find == 0) guessed_px = image.fx;
    if (find == 1) {
      EXPECT_GT(image.fx, 1.2 * guessed_px);
      const char* note = ossa_source_take_note(source, nullptr);
      EXPECT_NE(note != nullptr ? std::string(note).find("d435-color") : std::string::npos,
                std::string::npos);
    }
    ossa_source_close(source);
  }
}

TEST(CInterface, WhatASourceIsWronglyAskedForIsSaidInWords) {
  const test::TemporaryFolder folder;
  auto options = Sized<ossa_source_options>();
  options.depth_format = "sideways";
  EXPECT_EQ(ossa_source_open(folder.path().c_str(), &options), nullptr);
  EXPECT_TRUE(Says("sideways")) << ossa_last_error();
}

TEST(CInterface, MirroredImagesOfASourceComeAsTheSensorLooks) {
  const test::TemporaryFolder folder;
  const std::vector<uint16_t> row = {1000, 1001, 1002, 1003};
  depth::WriteDepthPng(folder / "0.png", {row.data(), 4, 1, 4});
  auto options = Sized<ossa_source_options>();
  options.camera = "5,6,1,0";
  options.mirrored = 1;
  ossa_source* source = ossa_source_open(folder.path().c_str(), &options);
  ASSERT_NE(source, nullptr) << ossa_last_error();
  auto image = Sized<ossa_depth_image>();
  ASSERT_EQ(ossa_source_read(source, 1000, &image), OSSA_OK) << ossa_last_error();
  EXPECT_EQ(std::vector<uint16_t>(image.depth_mm, image.depth_mm + 4),
            std::vector<uint16_t>(row.rbegin(), row.rend()));
  EXPECT_EQ(image.cx, 2.0);
  ossa_source_close(source);
}

// What a program's other thread sets when its user has enough of waiting.
struct Impatience {
  std::atomic<bool> has_enough = false;
  std::atomic<int> asked = 0;

  ossa_source_options Options() {
    auto options = Sized<ossa_source_options>();
    options.keep_waiting_user = this;
    options.keep_waiting = [](void* user) -> int32_t {
      auto* self = static_cast<Impatience*>(user);
      ++self->asked;
      return self->has_enough ? 0 : 1;
    };
    return options;
  }
  std::thread SetAfter(int questions) {
    return std::thread([this, questions] {
      while (asked < questions) std::this_thread::yield();
      has_enough = true;
    });
  }
};

TEST(CInterface, AnotherThreadEndsTheWaitForADevice) {
  Impatience user;
  ossa_source_options options = user.Options();
  options.wait_s = 3600.0;
  std::thread other = user.SetAfter(2);
  EXPECT_EQ(ossa_source_open("openni:ossa:///nowhere", &options), nullptr);
  other.join();
  EXPECT_TRUE(Says("openni:ossa:///nowhere")) << ossa_last_error();
}

TEST(CInterface, AnotherThreadEndsTheWaitForAFrame) {
  const test::TemporaryFolder folder;
  test::WriteExampleFolder(folder.path(), 1);
  const std::string silent = "openni:ossa://" + folder.path().string() + "?stall_after=1";
  Impatience user;
  const ossa_source_options options = user.Options();
  ossa_source* source = ossa_source_open(silent.c_str(), &options);
  ASSERT_NE(source, nullptr) << ossa_last_error();
  auto image = Sized<ossa_depth_image>();
  constexpr int32_t kAnHour_ms = 3'600'000;
  ASSERT_EQ(ossa_source_read(source, kAnHour_ms, &image), OSSA_OK) << ossa_last_error();
  std::thread other = user.SetAfter(user.asked + 2);
  EXPECT_EQ(ossa_source_read(source, kAnHour_ms, &image), OSSA_TIMEOUT) << ossa_last_error();
  other.join();
  ossa_source_close(source);
}

TEST(CInterface, TheSearchForWhichWayIsUpMayBeEnded) {
  OSSA_NEEDS_MODEL();
  const std::string clip = test::SourceFolder() / "tests/golden/clips/one";
  Impatience user;
  user.has_enough = true;
  const ossa_source_options options = user.Options();
  ossa_source* source = ossa_source_open(clip.c_str(), &options);
  ASSERT_NE(source, nullptr) << ossa_last_error();
  ossa_options of_tracker = PlainOptionsInC();
  of_tracker.rotate = "auto";
  ossa_tracker* tracker = ossa_tracker_create(&of_tracker);
  ASSERT_NE(tracker, nullptr) << ossa_last_error();
  EXPECT_EQ(ossa_tracker_find_upright(tracker, source), OSSA_OK) << ossa_last_error();
  EXPECT_EQ(user.asked, 1);
  ossa_tracker_destroy(tracker);
  ossa_source_close(source);
}

// Compiled before keep_waiting: what lies behind its struct is no function.
TEST(CInterface, AnOlderProgramsSourceOptionsAreReadAsFarAsTheyGo) {
  auto options = Impatience().Options();
  options.struct_size = offsetof(ossa_source_options, keep_waiting);
  options.keep_waiting = [](void*) -> int32_t { std::abort(); };
  EXPECT_EQ(ossa_source_open("openni:ossa:///nowhere", &options), nullptr);
  EXPECT_TRUE(Says("nowhere")) << ossa_last_error();
}

// Each made here, used in a thread of its own and destroyed in another; all see the same.
TEST(CInterface, TrackersWorkInSeveralThreadsAndEndInAnyOrder) {
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
