// Depth images and their sources in the C interface.
#include <gtest/gtest.h>

#include <atomic>
#include <cstddef>
#include <cstdlib>
#include <string>
#include <thread>
#include <vector>

#include "depth/image/camera_presets.h"
#include "depth/image/depth_png.h"
#include "tests/support/depth_examples.h"
#include "tests/support/places.h"
#include "tests/support/temporary_folder.h"
#include "tests/tools/tracker/walk_in_c.h"

namespace ossa::tracker {
namespace {

using test::ImageOf;
using test::PlainOptionsInC;
using test::Says;
using test::Sized;

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

// Left is left again after the mirrored image is unmirrored.
TEST(CInterface, MirroredImagesAreUnmirrored) {
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

// A very tall person, by a camera with a narrower view than the image size suggests.
TEST(CInterface, CameraSearchFindsANarrowerCamera) {
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

TEST(CInterface, SourceErrorsHaveMessages) {
  const test::TemporaryFolder folder;
  auto options = Sized<ossa_source_options>();
  options.depth_format = "sideways";
  EXPECT_EQ(ossa_source_open(folder.path().c_str(), &options), nullptr);
  EXPECT_TRUE(Says("sideways")) << ossa_last_error();
}

TEST(CInterface, SourceUnmirrorsMirroredImages) {
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

// Set by another thread of a program when its user cancels the wait.
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

TEST(CInterface, AnotherThreadInterruptsTheWaitForADevice) {
  Impatience user;
  ossa_source_options options = user.Options();
  options.wait_s = 3600.0;
  std::thread other = user.SetAfter(2);
  EXPECT_EQ(ossa_source_open("openni:ossa:///nowhere", &options), nullptr);
  other.join();
  EXPECT_TRUE(Says("openni:ossa:///nowhere")) << ossa_last_error();
}

TEST(CInterface, AnotherThreadInterruptsTheWaitForAFrame) {
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

TEST(CInterface, SearchForTheUprightRotationCanBeInterrupted) {
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

// Compiled before keep_waiting: the bytes after its struct are no function pointer.
TEST(CInterface, SmallerSourceOptionsOfOlderProgramsAreAccepted) {
  auto options = Impatience().Options();
  options.struct_size = offsetof(ossa_source_options, keep_waiting);
  options.keep_waiting = [](void*) -> int32_t { std::abort(); };
  EXPECT_EQ(ossa_source_open("openni:ossa:///nowhere", &options), nullptr);
  EXPECT_TRUE(Says("nowhere")) << ossa_last_error();
}

}  // namespace
}  // namespace ossa::tracker
